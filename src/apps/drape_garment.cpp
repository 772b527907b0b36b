// The program drape_garment: sews a garment on a body and lets it come to rest, see
// docs/garments.md. Needs no ROS master.
#include "haptex/dressing/drape_garment.h"

#include <ros/package.h>

#include <iostream>
#include <string>
#include <vector>

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  const std::string fabrics = ros::package::getPath("haptex") + "/config/fabrics";
  return haptex::dressing::drapeGarment(arguments, fabrics, std::cout, std::cerr);
}
