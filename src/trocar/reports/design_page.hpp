// Studies of a mechanism's design as a page for people: one HTML file with its drawings inside.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <trocar/studies/clearance.hpp>
#include <trocar/studies/optimise.hpp>
#include <trocar/studies/statistics.hpp>
#include <trocar/studies/tolerance.hpp>

namespace trocar::reports {

struct TolerancePage {
  std::string measured;  ///< in words
  std::string unit;      ///< of deviations
  double by = 1e6;       ///< from SI to that unit
  studies::Limits limits;
};
std::string tolerance_html(const studies::ToleranceStudy& study, const studies::Statistics& statistics,
                           const TolerancePage& page);

std::string clearance_html(const kinematics::Mechanism& m, const studies::ClearanceReport& report);

/// @param wish  clearance that was asked for [m]
std::string optimise_html(const kinematics::Mechanism& m, const studies::OptimiseResult& result, double wish);

/// Writes index.html. @return its path  @throws core::EnvironmentLacks
std::string write_design_page(const std::filesystem::path& folder, const std::string& html);

}  // namespace trocar::reports
