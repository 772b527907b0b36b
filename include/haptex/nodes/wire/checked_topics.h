// Topics and services whose messages are refused before memory is taken if they claim arrays that
// are longer than their bytes. Only messages with arrays of any length need it.
#pragma once

#include <ros/node_handle.h>

#include <boost/make_shared.hpp>
#include <cstddef>
#include <cstdint>
#include <string>

#include "haptex/nodes/wire/claimed_length.h"

namespace haptex::nodes {

/// What the following throw, roscpp tells the caller of a service, and in the log, there with the
/// length of the message and who sent it.
template <typename Spec>
class CheckedService : public ros::ServiceCallbackHelperT<Spec> {
 public:
  using Base = ros::ServiceCallbackHelperT<Spec>;
  using Base::Base;

  bool call(ros::ServiceCallbackHelperCallParams& params) override {
    const ros::SerializedMessage& request = params.request;
    const std::size_t before = static_cast<std::size_t>(request.message_start - request.buf.get());
    requireClaimsFit<typename Spec::RequestType>(
        request.message_start, static_cast<std::uint32_t>(request.num_bytes - before));
    return Base::call(params);
  }
};

template <typename Parameter>
class CheckedSubscription : public ros::SubscriptionCallbackHelperT<Parameter> {
 public:
  using Base = ros::SubscriptionCallbackHelperT<Parameter>;
  using Base::Base;

  ros::VoidConstPtr deserialize(
      const ros::SubscriptionCallbackHelperDeserializeParams& params) override {
    requireClaimsFit<typename Base::NonConstType>(params.buffer, params.length);
    return Base::deserialize(params);
  }
};

/// As NodeHandle::advertiseService().
template <typename Owner, typename Request, typename Response>
ros::ServiceServer advertiseChecked(ros::NodeHandle node, const std::string& name,
                                    bool (Owner::*callback)(Request&, Response&), Owner* owner) {
  const boost::function<bool(Request&, Response&)> call = [callback, owner](Request& request,
                                                                            Response& response) {
    return (owner->*callback)(request, response);
  };
  ros::AdvertiseServiceOptions options;
  options.init<Request, Response>(name, call);
  options.helper = boost::make_shared<CheckedService<ros::ServiceSpec<Request, Response>>>(call);
  return node.advertiseService(options);
}

/// As NodeHandle::subscribe(). @param callback takes Parameter: const Message& or a pointer to
/// const
template <typename Parameter>
ros::Subscriber subscribeChecked(ros::NodeHandle node, const std::string& topic,
                                 std::uint32_t queue,
                                 const boost::function<void(Parameter)>& callback,
                                 const ros::TransportHints& hints = ros::TransportHints()) {
  ros::SubscribeOptions options;
  options.initByFullCallbackType<Parameter>(topic, queue, callback);
  options.helper = boost::make_shared<CheckedSubscription<Parameter>>(callback);
  options.transport_hints = hints;
  return node.subscribe(options);
}

}  // namespace haptex::nodes
