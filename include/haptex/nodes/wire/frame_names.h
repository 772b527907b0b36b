// Names of the tf frames that the nodes know. Two graphs in one master have frames of their own by
// a prefix, the parameter tf_prefix: robot_state_publisher reads the same one.
#pragma once

#include <string>

#include "haptex/base/finger.h"

namespace haptex::nodes {

/// For this process: frames are then called PREFIX/name. To be called before the functions below,
/// and before there are threads. @param prefix empty: none
/// @throws std::invalid_argument unless it is letters, digits and _, in parts between single
/// slashes
void setFramePrefix(const std::string& prefix);

/// What all frames of this process begin with, with its slash; empty if there is no prefix.
const std::string& framePrefix();
/// One that a scene names.
std::string frameCalled(const std::string& name);
/// What a scene would call the frame of a message, which carries particles.
/// @param frame_id not fixedFrame() @throws std::invalid_argument naming it and what is allowed,
///   unless it is framePrefix() and then a scene::isFrameName()
std::string carryingFrame(const std::string& frame_id);
/// The frame of the cloth and of everything that is not said otherwise, z up.
const std::string& fixedFrame();
/// The frame of everything that the exoskeleton measures and is commanded; its root in the URDF.
const std::string& handFrame();
/// Of the fingertip, and of the array of contactors under it.
const std::string& tipFrame(base::Finger finger);
const std::string& arrayFrame(base::Finger finger);

}  // namespace haptex::nodes
