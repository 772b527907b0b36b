// The program import_btf: a measured bidirectional texture function, see docs/appearance.md.
#include <cstdlib>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "haptex/appearance/btf_file.h"
#include "haptex/appearance/btf_measures.h"
#include "haptex/appearance/measured_btf.h"
#include "haptex/base/command_line.h"
#include "haptex/base/quoted.h"

namespace {

using namespace haptex;

constexpr const char* kUsage =
    "usage: import_btf FOLDER WIDTH OUT.btf\n"
    "Compresses photographs of a fabric from 81 directions with light from 81 directions each, and "
    "prints\n"
    "how true that is. FOLDER has them as UBO2003 does, \"... tl075 pl345 tv015 pv060.jpg\": polar "
    "angle and\n"
    "azimuth of light and view in degrees. They show WIDTH m of the fabric along its weft.\n";

constexpr appearance::Compression kCompression{128, 64, 80};
constexpr unsigned kSeed = 1;

double numberOf(const std::string& text) {
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0') {
    throw std::invalid_argument("the width " + base::quoted(text) + " is no number");
  }
  return number;
}

void import(const std::vector<std::string>& arguments) {
  const double width = numberOf(arguments[1]);
  const appearance::MeasuredImages images(arguments[0]);
  const appearance::Btf btf = appearance::makeBtf(images, width, kCompression);
  std::cout << "file: " << appearance::writeBtf(btf, arguments[2]) << " bytes, " << images.columns()
            << " x " << images.rows() << " texels" << std::endl;
  std::cout << "error: " << appearance::compressionError(btf, images) << " of the mean"
            << std::endl;
  std::cout << "reciprocity: " << appearance::reciprocityError(btf, {192, 32, 1, 1, kSeed})
            << std::endl;
}

}  // namespace

int main(int argc, char** argv) {
  return base::runPlainProgram("import_btf", kUsage, {argv + 1, argv + argc}, 3, 3, import);
}
