#include "haptex/nodes/force_renderer/patch_supplier.h"

#include <exception>
#include <optional>
#include <stdexcept>
#include <utility>

#include "haptex/nodes/force_renderer/renderer_messages.h"
#include "haptex/realtime/scheduling.h"
#include "haptex/realtime/steady_clock.h"

namespace haptex::nodes {
namespace {

using base::Time;

constexpr Time kPatience = std::chrono::milliseconds(2);
constexpr Time kConnectionPeriod = std::chrono::milliseconds(50);
/// Until the forces have fallen to zero before a layer is exchanged.
constexpr Time kFall = simulation::RendererLiveness::kFall + std::chrono::milliseconds(4);

/// And the same number and gravity.
bool hasSameFabric(const haptex::ClothMesh& a, const haptex::ClothMesh& b) {
  return a.mesh == b.mesh && a.fabrics == b.fabrics && a.fabric_files == b.fabric_files &&
         a.factors == b.factors && a.gravity == b.gravity;
}

}  // namespace

PatchSupplier::PatchSupplier(const ros::NodeHandle& node, LayerBuilder builder,
                             simulation::ForceLoop& loop)
    : node_(node), builder_(std::move(builder)), loop_(loop) {
  status_.trouble = "cloth/mesh has not come yet";
  force_publisher_ = node_.advertise<haptex::ContactForces>("cloth/contact_forces", 2);
  thread_ = std::thread([this] { run(); });
}

PatchSupplier::~PatchSupplier() { stop(); }

void PatchSupplier::stop() {
  stopping_ = true;
  if (thread_.joinable()) thread_.join();
}

void PatchSupplier::setMesh(const haptex::ClothMeshConstPtr& message) {
  const std::lock_guard<std::mutex> lock(mutex_);
  incoming_mesh_ = message;
}

void PatchSupplier::setAttached(const std::vector<char>& attached) {
  const std::lock_guard<std::mutex> lock(mutex_);
  attached_ = attached;
}

PatchSupplierStatus PatchSupplier::status() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return status_;
}

void PatchSupplier::run() {
  realtime::askForFifoOnce(realtime::kMessagePriority);
  realtime::keepOffForceProcessor(pthread_self());
  while (!stopping_) {
    loop_.waitForNews(kPatience);
    takeMesh();
    const simulation::LoopView& view = loop_.view();
    publishForces(view);
    const bool patches = builder_.settings().layer == contact::HapticSettings::Layer::kPatch;
    if (layer_ == nullptr || !patches) continue;
    // A server that has died closes the connection: do not wait for the next question to see it.
    if (!failed_ && !client_.isValid()) fail("the connection to proximity/query is broken");
    if (view.states != states_asked_ || realtime::steadyNow() >= next_question_) ask(view);
    supplyPatch();
  }
}

/// Messages come from outside: a mesh that no layer can be made of leaves the loop without one.
void PatchSupplier::takeMesh() {
  haptex::ClothMeshConstPtr message;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    message.swap(incoming_mesh_);
  }
  if (!message) return;
  std::string trouble;
  try {
    RestMesh mesh = restMesh(*message);
    if (layer_ != nullptr && mesh == mesh_ && hasSameFabric(*message, *message_)) return;
    loop_.setLayerReady(false);
    mesh_ = std::move(mesh);
    message_ = message;
    buildLayer(*message);
  } catch (const std::exception& error) {
    trouble = error.what();
    ROS_ERROR("There are no forces: %s", error.what());
    loop_.setLayerReady(false);
    layer_ = nullptr;
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  status_.trouble = trouble;
  status_.triangles = 0;
}

void PatchSupplier::buildLayer(const haptex::ClothMesh& message) {
  const Time begin = realtime::steadyNow();
  auto update = std::make_unique<simulation::LayerUpdate>();
  {
    const realtime::OrdinaryScope ordinary;
    update->layer = builder_.build(message);
  }
  update->replaces_layer = true;
  update->particles = message.rest_weft_coordinates.size();
  update->mesh = message.mesh;
  layer_ = update->layer.get();
  while ((realtime::steadyNow() < begin + kFall || !loop_.canOffer()) && !stopping_) {
    loop_.waitForNews(kPatience);
  }
  if (stopping_) return;
  loop_.offer(std::move(update));
  loop_.setLayerReady(true);
  supply_.emplace(builder_.settings(), mesh_.triangles.size());
}

/// Once per state of the cloth; one without points ends the contact.
void PatchSupplier::publishForces(const simulation::LoopView& view) {
  if (view.loadings == loadings_published_) return;
  loadings_published_ = view.loadings;
  if (force_publisher_.getNumSubscribers() == 0) return;
  if (layer_ != nullptr) {
    simulation::fillActingLoads(view, loads_);
  } else {
    loads_.clear();
  }
  if (loads_.empty() && !published_forces_) return;
  fillContactForces(loads_, ros::Time::now(), forces_);
  forces_.mesh = view.mesh;
  force_publisher_.publish(forces_);
  published_forces_ = !loads_.empty();
}

void PatchSupplier::fail(const std::string& why) {
  loop_.reportAnswer(false);
  failed_ = true;
  client_.shutdown();
  const std::lock_guard<std::mutex> lock(mutex_);
  ++status_.failures;
  status_.query_trouble = why;
}

void PatchSupplier::ask(const simulation::LoopView& view) {
  const Time begin = realtime::steadyNow();
  next_question_ = begin + kAskPeriod;
  states_asked_ = view.states;
  if (!client_.isValid()) {
    if (begin < next_connection_) return;
    next_connection_ = begin + kConnectionPeriod;
    client_ = node_.serviceClient<Query>("proximity/query", true);
    if (!client_.isValid()) {
      fail("there is no proximity/query: is the node proximity running?");
      return;
    }
  }
  const auto search = [this](const contact::SearchVolume& volume,
                             contact::PatchSelection& selection) {
    return askAbout(volume, selection);
  };
  if (!supply_->ask(view, search)) return;
  const Time end = realtime::steadyNow();
  failed_ = false;
  loop_.reportAnswer(true);
  const std::lock_guard<std::mutex> lock(mutex_);
  ++status_.queries;
  status_.query_trouble.clear();
  status_.query_seconds = base::seconds(end - begin);
  supply_->setAttached(attached_);
}

bool PatchSupplier::askAbout(const contact::SearchVolume& volume,
                             contact::PatchSelection& selection) {
  Query::Request request = volumeQuery(volume);
  Query::Response response;
  loop_.reportQuestion(realtime::steadyNow());
  if (!client_.call(request, response)) {
    fail("proximity/query does not answer: is the node proximity running?");
    return false;
  }
  if (!response.success) {
    fail("proximity/query refuses: " + response.message);
    return false;
  }
  try {
    addFound(response, mesh_.triangles.size(), builder_.settings(), selection);
  } catch (const std::invalid_argument& error) {
    fail(std::string("the answer of proximity/query: ") + error.what());
    return false;
  }
  return true;
}

void PatchSupplier::supplyPatch() {
  if (!loop_.canOffer() || !supply_->isOutdated()) return;
  if (supply_->attachedSize() != mesh_.rest_coordinates.size()) return;  // of another mesh
  auto update = std::make_unique<simulation::LayerUpdate>();
  {
    const realtime::OrdinaryScope ordinary;
    update->patch = supply_->prepare(*layer_);
  }
  update->replaces_patch = true;
  loop_.offer(std::move(update));
  const std::lock_guard<std::mutex> lock(mutex_);
  status_.triangles = supply_->triangles().size();
}

}  // namespace haptex::nodes
