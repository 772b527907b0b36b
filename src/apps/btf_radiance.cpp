// The program btf_radiance: values of a bidirectional texture function for a renderer, see
// docs/appearance.md.
#include <string>
#include <vector>

#include "haptex/appearance/btf_file.h"
#include "haptex/appearance/btf_requests.h"
#include "haptex/base/command_line.h"
#include "haptex/base/processors.h"

namespace {

using namespace haptex;

constexpr const char* kUsage =
    "usage: btf_radiance FABRIC.btf REQUESTS OUT\n"
    "Evaluates what fabric_btf has written. REQUESTS has records of nine numbers of 4 bytes: "
    "directions\n"
    "to the eye and to the light (x along weft, y along warp, z out of the face), a place (m, "
    "along weft\n"
    "and warp), and the width of the square around it that is seen (m). OUT gets three for each: "
    "red,\n"
    "green and blue.\n";

void evaluate(const std::vector<std::string>& files) {
  const appearance::Btf btf = appearance::readBtf(files[0]);
  appearance::writeRadiance(
      appearance::radianceOf(btf, appearance::readRequests(files[1]), base::processorCount()),
      files[2]);
}

}  // namespace

int main(int argc, char** argv) {
  return base::runPlainProgram("btf_radiance", kUsage, {argv + 1, argv + argc}, 3, 3, evaluate);
}
