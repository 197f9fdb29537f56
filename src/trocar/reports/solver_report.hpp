// What `trocar compare` leaves in a folder: the difference of both solvers over time as a table for programs and as a
// page for people.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <trocar/attempt/solver_comparison.hpp>
#include <trocar/core/json.hpp>
#include <trocar/pictures/solver_pictures.hpp>

namespace trocar::reports {

/// A press of a given depth, for the table.
struct SolverPress {
  double depth = 0;  ///< [m]
  double share = 0;  ///< of the organ's size [-]
  attempt::SolverSummary summary;
};

struct SolverReport {
  std::string organ, scene;  ///< names
  std::string hands;         ///< in words
  double size = 0;           ///< of the organ [m]
  std::vector<attempt::SolverSample> samples;
  attempt::SolverSummary summary;
  std::vector<SolverPress> presses;  ///< may be empty
  std::vector<pictures::SolverPicture> pictures;
  std::string pictures_note;  ///< why there are none
};

/// time_s,moved_mm,rms_mm,largest_mm,rms_percent,largest_percent,dynamic_N,static_N,force_percent,settled; a share
/// without an indentation or a force is empty.
std::string difference_csv(const std::vector<attempt::SolverSample>& samples);

Json as_json(const attempt::SolverSample& sample);
std::string solvers_html(const SolverReport& report);

/// Writes difference.csv and index.html. @return the page's path
/// @throws core::EnvironmentLacks
std::string write_solver_report(const std::filesystem::path& folder, const SolverReport& report);

}  // namespace trocar::reports
