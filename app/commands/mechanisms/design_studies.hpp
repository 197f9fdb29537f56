// The studies of `trocar mechanism`: tolerance, clearance, optimise.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <trocar/kinematics/chains/mechanism.hpp>

#include "commands/mechanisms/study_options.hpp"

namespace trocar::app {

struct DesignOptions {
  StudyOptions study;
  std::vector<std::string> ignored;  ///< "LINK:LINK"
  int steps = 200, poses = 2000;
  double clearance_um = 100, keep = 0.95;
  bool strict = false;
  std::string report;          ///< folder; empty: none
  std::string output;          ///< of optimise: the file that is written; empty: none
  std::filesystem::path path;  ///< of the mechanism
};
void add_design_options(CLI::App& command, DesignOptions& options);

/// @return the exit code
int show_tolerance(const kinematics::Mechanism& m, const DesignOptions& options, bool json);
int show_clearance(const kinematics::Mechanism& m, const DesignOptions& options, bool json);
int show_optimised(const kinematics::Mechanism& m, const DesignOptions& options, bool json);

}  // namespace trocar::app
