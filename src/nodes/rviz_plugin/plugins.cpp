// What rviz finds in this library; plugin_description.xml says the same.
#include <pluginlib/class_list_macros.hpp>

#include "haptex/nodes/rviz_plugin/cloth_display.h"
#include "haptex/nodes/rviz_plugin/contact_display.h"
#include "haptex/nodes/rviz_plugin/panel.h"

PLUGINLIB_EXPORT_CLASS(haptex::nodes::ClothDisplay, rviz::Display)
PLUGINLIB_EXPORT_CLASS(haptex::nodes::ContactDisplay, rviz::Display)
PLUGINLIB_EXPORT_CLASS(haptex::nodes::Panel, rviz::Panel)
