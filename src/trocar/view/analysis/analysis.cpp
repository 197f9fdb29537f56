#include <cmath>
#include <cstdio>

#include <trocar/vessels/graph.hpp>
#include <trocar/view/analysis/analysis.hpp>

namespace trocar::view {
namespace {

constexpr int kBarColours = 41;

std::string number(const char* format, double value) {
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::vector<Colour> colours_of(Scale scale) {
  std::vector<Colour> colours;
  for (int i = 0; i < kBarColours; ++i) {
    const double share = double(i) / (kBarColours - 1);
    colours.push_back(colour_on(scale, scale == Scale::diverging ? 2 * share - 1 : share));
  }
  return colours;
}

Legend::Bar strain_bar(const AnalysisOptions& o) {
  const char* what = !o.springs ? "strain of surfaces [%]" : !o.strain ? "strain of springs [%]" : "strain [%]";
  Legend::Bar bar{what, colours_of(Scale::diverging), {}};
  for (const double share : {-1.0, -0.5, 0.0, 0.5, 1.0})
    bar.ticks.push_back(number(share == 0 ? "%.3g" : "%+.3g", 100 * share * o.strain_range));
  return bar;
}

Legend::Bar pressure_bar(const AnalysisOptions& o) {
  Legend::Bar bar{"pressure in vessels [mmHg]", colours_of(Scale::sequential), {}};
  for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0}) bar.ticks.push_back(number("%.3g", share * o.pressure_most));
  return bar;
}

Legend::Bar distance_bar(const AnalysisOptions& o) {
  Legend::Bar bar{"distance between both solvers [mm]", colours_of(Scale::sequential), {}};
  for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0})
    bar.ticks.push_back(number("%.3g", 1e3 * share * o.apart_most));
  return bar;
}

}  // namespace

Colour colour_of_pressure(const AnalysisOptions& o, double pressure) {
  return colour_on(Scale::sequential, pressure / (o.pressure_most * vessels::kPascalPerMmHg));
}

Colour colour_of(ForceKind kind) {
  switch (kind) {
    case ForceKind::grip:
      return {0.94f, 0.89f, 0.26f};  // yellow
    case ForceKind::touch:
      return {0.00f, 0.62f, 0.45f};  // bluish green
    case ForceKind::trocar:
      break;
  }
  return {0.80f, 0.47f, 0.65f};  // reddish purple
}

Legend legend_of(const AnalysisOptions& o) {
  Legend legend;
  if (o.springs || o.strain) legend.bars.push_back(strain_bar(o));
  if (o.pressure) legend.bars.push_back(pressure_bar(o));
  if (o.solvers) {
    legend.bars.push_back(distance_bar(o));
    legend.keys.push_back({kOtherSolver, "outline of the other solver"});
  }
  if (o.forces) {
    const std::string length = ", " + number("%.3g", 1e3 * o.force_length) + " mm/N";
    legend.keys.push_back({colour_of(ForceKind::grip), "jaws pull at tissue" + length});
    legend.keys.push_back({colour_of(ForceKind::touch), "pressed on tissue" + length});
    legend.keys.push_back({colour_of(ForceKind::trocar), "trocar on the wall" + length});
  }
  return legend;
}

}  // namespace trocar::view
