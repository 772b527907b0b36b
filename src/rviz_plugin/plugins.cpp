// What rviz finds in this library; plugin_description.xml says the same.
#include <pluginlib/class_list_macros.hpp>

#include "haptex/rviz_plugin/cloth_display.h"
#include "haptex/rviz_plugin/contact_display.h"
#include "haptex/rviz_plugin/panel.h"

PLUGINLIB_EXPORT_CLASS(haptex::rviz_plugin::ClothDisplay, rviz::Display)
PLUGINLIB_EXPORT_CLASS(haptex::rviz_plugin::ContactDisplay, rviz::Display)
PLUGINLIB_EXPORT_CLASS(haptex::rviz_plugin::Panel, rviz::Panel)
