#include "haptex/material/fit_curves.h"

#include <exception>
#include <filesystem>
#include <optional>
#include <ostream>
#include <sstream>

#include "haptex/base/command_line.h"
#include "haptex/base/parse_number.h"
#include "haptex/base/require.h"
#include "haptex/material/fabric_writer.h"

namespace haptex::material {

const char* const kFitCurvesUsage =
    "usage: fit_curves CSV [--pieces N] [--name NAME]\n"
    "Makes a fabric file, on standard output, of a tester's readings, and prints how far the "
    "fitted\n"
    "curves, of N cubics each (8), are from them, on standard error: docs/fit_curves.md.\n";

namespace {

int piecesOf(const std::string& text) {
  const std::optional<int> pieces = base::parseNumber<int>(text);
  if (!pieces || *pieces < 1 || *pieces > kMostPieces) {
    base::refuse("--pieces ", text, ": allowed are whole numbers from 1 to ", kMostPieces);
  }
  return *pieces;
}

}  // namespace

FitRequest parseFitRequest(const std::vector<std::string>& arguments) {
  const base::CommandLine line = base::readCommandLine(arguments, {"--pieces", "--name"});
  FitRequest request;
  if (line.options.count("--pieces") > 0) request.pieces = piecesOf(line.value("--pieces"));
  request.name = line.value("--name");
  if (line.files.size() > 1) {
    base::refuse(line.files[1], ": one file of readings is allowed, ", line.files[0], " is there");
  }
  if (!line.files.empty()) request.file = line.files[0];
  if (request.file.empty()) base::refuse("the file of readings is missing");
  if (request.name.empty()) request.name = std::filesystem::path(request.file).stem().string();
  return request;
}

void printReport(const FitReport& report, std::ostream& out) {
  out << "# fit\ttest\treadings\tpieces\trms\tlargest\tunit\trms_percent\tlargest_percent\n";
  for (const auto& [name, readings, pieces, residuals, unit] : report.curves) {
    const auto percent = [&, scale = residuals.scale](double residual) {
      std::ostringstream text;
      text.precision(3);
      text << 100.0 * residual / scale;
      return text.str();
    };
    std::ostringstream numbers;
    numbers.precision(4);
    numbers << residuals.rms << '\t' << residuals.largest;
    out << "fit\t" << name << '\t' << readings << '\t' << pieces << '\t' << numbers.str() << '\t'
        << unit << '\t' << percent(residuals.rms) << '\t' << percent(residuals.largest) << '\n';
  }
  out << "# parameter\tname\tunit\tvalue\tstated\n";
  for (const auto& [name, unit, value, stated] : report.parameters) {
    std::ostringstream numbers;
    numbers.precision(5);
    numbers << value << '\t';
    if (stated) {
      numbers << *stated;
    } else {
      numbers << '-';
    }
    out << "parameter\t" << name << '\t' << unit << '\t' << numbers.str() << '\n';
  }
}

int fitCurves(const std::vector<std::string>& arguments, std::ostream& out, std::ostream& notes) {
  FitRequest request;
  try {
    request = parseFitRequest(arguments);
  } catch (const base::HelpAsked&) {
    out << kFitCurvesUsage;
    return 0;
  } catch (const std::exception& error) {
    notes << "fit_curves: " << error.what() << '\n' << kFitCurvesUsage;
    return 2;
  }
  try {
    const TesterFit fit = fitFabric(readTesterFile(request.file), request.name, request.pieces);
    printReport(fit.report, notes);
    writeFabric(fit.fabric, out);
  } catch (const std::exception& error) {
    notes << "fit_curves: " << error.what() << '\n';
    return 1;
  }
  return 0;
}

}  // namespace haptex::material
