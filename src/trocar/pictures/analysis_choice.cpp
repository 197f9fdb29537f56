#include <algorithm>
#include <cstdio>
#include <iterator>
#include <sstream>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/pictures/analysis_choice.hpp>

namespace trocar::pictures {
namespace {

[[noreturn]] void refuse_analysis(const std::string& what) { throw core::BadInput({{{"--analysis", 0, 0}, what}}); }

}  // namespace

view::AnalysisOptions parse_analysis(const std::string& text) {
  view::AnalysisOptions options;
  std::istringstream items(text);
  for (std::string item; std::getline(items, item, ',');) {
    const std::size_t colon = item.find(':');
    const std::string name = item.substr(0, colon);
    const auto known = std::find_if(std::begin(kAnalysisQuantities), std::end(kAnalysisQuantities),
                                    [&name](const AnalysisQuantity& q) { return name == q.name; });
    if (name == "solvers")  // of the analysis view all the same, but not of any scene
      refuse_analysis(
          "expected springs, strain, forces or pressure, got 'solvers', for which another simulation has to "
          "run beside: trocar compare draws it");
    if (known == std::end(kAnalysisQuantities))
      refuse_analysis(tr("expected springs, strain, forces or pressure, with commas between, got '{}'", item));
    options.*known->shown = true;
    if (colon == std::string::npos) continue;
    double range = 0;
    char rest = 0;
    const bool read = std::sscanf(item.c_str() + colon, ":%lf%c", &range, &rest) == 1;
    if (!read || !(range >= known->least && range <= known->most))
      refuse_analysis(tr("expected {}:RANGE from {:g} to {:g}, got '{}'", name, known->least, known->most, item));
    options.*known->range = range * known->unit;
  }
  return options;
}

}  // namespace trocar::pictures
