// --analysis: which figures a picture shows in colour, and over what range.
//
//   const view::AnalysisOptions analysis = parse_analysis("strain:30,forces");   // scale ends at 30 %
#pragma once

#include <string>

#include <trocar/view/analysis/analysis.hpp>

namespace trocar::pictures {

inline constexpr const char* kAnalysisHelp =
    "of pictures and film, figures in colour: springs | strain | forces | pressure, one or more with commas; with "
    ":RANGE "
    "if wanted (springs, strain: % at the scale's ends; forces: mm of arrow per N; pressure: mmHg at its end)";

/// What people choose from, in the order of the switches.
struct AnalysisQuantity {
  const char* name;
  const char* meaning;
  bool view::AnalysisOptions::*shown;
  double view::AnalysisOptions::*range;
  double unit;         ///< of the range as people write it, in that of the options
  double least, most;  ///< as people write it
};
inline constexpr AnalysisQuantity kAnalysisQuantities[] = {
    {"springs", "springs, by how far they are stretched", &view::AnalysisOptions::springs,
     &view::AnalysisOptions::strain_range, 0.01, 0.1, 500},
    {"strain", "surfaces, by how far they are stretched", &view::AnalysisOptions::strain,
     &view::AnalysisOptions::strain_range, 0.01, 0.1, 500},
    {"forces", "what instruments exert", &view::AnalysisOptions::forces, &view::AnalysisOptions::force_length, 0.001,
     0.1, 1000},
    {"pressure", "vessels, by the blood's pressure", &view::AnalysisOptions::pressure,
     &view::AnalysisOptions::pressure_most, 1, 1, 1000},
};

/// Empty: nothing.  @throws core::BadInput naming what was expected
view::AnalysisOptions parse_analysis(const std::string& text);

}  // namespace trocar::pictures
