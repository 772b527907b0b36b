// Sends states as a cloth does, without a cloth, or receives them: what bench/network measures.
//   state_stream send FORM CELLS RATE   to state_stream, until it is told to end; then prints the
//                                       processor time of a state (ms)
//   state_stream receive FORM COUNT     prints of so many states: bytes of one, how many came in a
//                                       second, the median and the 99th percentile of their age
//                                       (ms), and the processor time of one (ms)
// FORM is `state`, a haptex/ClothState; or a sensor_msgs/PointCloud2 in single precision with what
// that has, `single`, or with positions alone, `positions`.
#include <haptex/ClothState.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <sensor_msgs/PointCloud2.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <stdexcept>
#include <string>
#include <vector>

#include "haptex/base/parse_number.h"

namespace {

using sensor_msgs::PointCloud2;

constexpr double kPatience = 60.0;  // s, until all states are there
constexpr int kFirst = 5;           // states that are not counted

double processorMilliseconds() { return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Numbers of a particle in a cloud.
int numbersOf(const std::string& form) { return form == "single" ? 9 : 3; }

/// Or a cloud. @throws std::invalid_argument if there is no such form
bool isWhole(const std::string& form) {
  if (form == "state") return true;
  if (form == "single" || form == "positions") return false;
  throw std::invalid_argument("no form '" + form + "'; there is: state single positions");
}

/// Values change from state to state, as those of a cloth that moves.
haptex::ClothState stateOf(std::size_t particles) {
  haptex::ClothState state;
  state.header.frame_id = "world";
  state.positions.resize(particles);
  state.velocities.resize(particles);
  state.forces.resize(particles);
  return state;
}

void move(haptex::ClothState& state) {
  ++state.step;
  for (auto& position : state.positions) position.z += 1e-6;
}

/// In single precision, as a node would have to convert each state.
void convert(const haptex::ClothState& state, int numbers, PointCloud2& cloud) {
  cloud.header.frame_id = state.header.frame_id;
  cloud.height = 1;
  cloud.width = static_cast<std::uint32_t>(state.positions.size());
  cloud.point_step = static_cast<std::uint32_t>(numbers * sizeof(float));
  cloud.row_step = cloud.point_step * cloud.width;
  cloud.is_dense = 1;
  cloud.data.resize(cloud.row_step);
  std::vector<float> values(numbers);
  for (std::size_t i = 0; i < state.positions.size(); ++i) {
    const double all[9] = {state.positions[i].x,  state.positions[i].y,  state.positions[i].z,
                           state.velocities[i].x, state.velocities[i].y, state.velocities[i].z,
                           state.forces[i].x,     state.forces[i].y,     state.forces[i].z};
    std::copy_n(all, numbers, values.begin());
    std::memcpy(&cloud.data[i * cloud.point_step], values.data(), cloud.point_step);
  }
}

/// @throws std::invalid_argument if it is none, or not above 0
template <typename Number>
Number positive(const std::string& name, const std::string& text) {
  const auto number = haptex::base::parseNumber<Number>(text);
  if (number && *number > 0 && std::isfinite(double(*number))) return *number;
  throw std::invalid_argument(name + " is '" + text + "': must be a number above 0");
}

void send(const std::string& form, int cells, double rate) {
  const bool whole = isWhole(form);
  const int numbers = whole ? 0 : numbersOf(form);
  ros::NodeHandle node;
  const ros::Publisher publisher = whole ? node.advertise<haptex::ClothState>("state_stream", 1)
                                         : node.advertise<PointCloud2>("state_stream", 1);
  haptex::ClothState state = stateOf(static_cast<std::size_t>(cells + 1) * (cells + 1));
  PointCloud2 cloud;
  ros::AsyncSpinner spinner(1);
  spinner.start();
  while (ros::ok() && publisher.getNumSubscribers() == 0) ros::WallDuration(0.01).sleep();
  const double begin = processorMilliseconds();
  ros::WallRate due(rate);
  while (ros::ok()) {
    move(state);
    state.header.stamp = ros::Time::now();
    if (whole) {
      publisher.publish(state);
    } else {
      convert(state, numbers, cloud);
      cloud.header.stamp = state.header.stamp;
      publisher.publish(cloud);
    }
    due.sleep();
  }
  std::printf("%.4g\n", (processorMilliseconds() - begin) / std::max(1.0, double(state.step)));
}

struct Received {
  std::vector<double> ages;  // ms
  std::size_t bytes = 0;
  double begin = 0.0, end = 0.0;  // s, of the first and the last that is counted
  int count = 0;
};

template <typename Message>
Received receive(int most) {
  ros::NodeHandle node;
  Received received;
  const boost::function<void(const typename Message::ConstPtr&)> take =
      [&](const typename Message::ConstPtr& message) {
        const ros::Time now = ros::Time::now();
        if (++received.count <= kFirst) return;
        if (received.ages.empty()) received.begin = now.toSec();
        received.end = now.toSec();
        received.ages.push_back(1e3 * (now - message->header.stamp).toSec());
        received.bytes = ros::serialization::serializationLength(*message);
      };
  const ros::Subscriber subscriber = node.subscribe<Message>(
      "state_stream", 1, take, ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay());
  const ros::WallTime give_up = ros::WallTime::now() + ros::WallDuration(kPatience);
  while (ros::ok() && static_cast<int>(received.ages.size()) < most &&
         ros::WallTime::now() < give_up) {
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.1));
  }
  return received;
}

void print(Received received, double milliseconds) {
  std::vector<double>& ages = received.ages;
  if (ages.size() < 2) throw std::runtime_error("no states came");
  std::sort(ages.begin(), ages.end());
  const auto last = static_cast<double>(ages.size() - 1);
  std::printf("%zu %.4g %.4g %.4g %.4g\n", received.bytes, last / (received.end - received.begin),
              ages[static_cast<std::size_t>(0.5 * last)],
              ages[static_cast<std::size_t>(0.99 * last)], milliseconds / received.count);
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "state_stream", ros::init_options::AnonymousName);
  ros::console::set_logger_level(ROSCONSOLE_ROOT_LOGGER_NAME, ros::console::levels::Warn);
  try {
    const std::vector<std::string> arguments(argv + 1, argv + argc);
    if (arguments.size() == 4 && arguments[0] == "send") {
      send(arguments[1], positive<int>("CELLS", arguments[2]),
           positive<double>("RATE", arguments[3]));
    } else if (arguments.size() == 3 && arguments[0] == "receive") {
      const double begin = processorMilliseconds();
      const int count = positive<int>("COUNT", arguments[2]);
      const Received received =
          isWhole(arguments[1]) ? receive<haptex::ClothState>(count) : receive<PointCloud2>(count);
      print(received, processorMilliseconds() - begin);
    } else {
      throw std::invalid_argument("usage: state_stream send FORM CELLS RATE | receive FORM COUNT");
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "state_stream: %s\n", error.what());
    return 1;
  }
  return 0;
}
