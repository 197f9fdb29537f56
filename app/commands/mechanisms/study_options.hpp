// What a tolerance study is asked for on a command line, and its answer as JSON: shared by the program and by the one
// that runs over MPI, so that both say the same numbers.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include <trocar/core/json.hpp>
#include <trocar/studies/statistics.hpp>
#include <trocar/studies/tolerance.hpp>

namespace trocar::app {

/// Throws core::BadInput about a word of the command line.
[[noreturn]] void refuse_words(const std::string& word, const std::string& message);

/// A file, or the name of one under scenes/mechanisms.
std::filesystem::path mechanism_file(const std::string& name);

/// The frame that is meant: the given one; where none is given, "tip", else the mechanism's first one.
std::string frame_or_tip(const kinematics::Mechanism& m, const std::string& given);

/// "NAME=NUMBER"
std::pair<std::string, double> assignment(const std::string& word);

struct StudyOptions {
  std::string file, frame, from, along = "x", turn;
  std::vector<std::string> drives;
  bool distance = false, uniform = false;
  double plus_minus_um = 0, plus_minus_deg = 0, within = 0;
  int samples = 100'000, bins = 41, threads = 0;
  std::int64_t seed = 1;
};

/// Options of the study alone, without the file, --frame, --drive and --samples, which commands share.
void add_study_options(CLI::App& command, StudyOptions& options);

/// Of what a deviation is told in: micrometres, or thousandths of a degree.
struct StudyUnit {
  const char* name = "um";
  double by = 1e6;  ///< from SI
};
StudyUnit unit_of(const studies::Measured& what);

struct StudyTask {
  studies::Measured what;
  std::string words;  ///< what is measured
  std::vector<double> handles;
  studies::Limits limits;
  StudyUnit unit;
  std::optional<studies::ToleranceStudy> study;
};
/// @throws core::BadInput about words; std::invalid_argument where the pose is no good
StudyTask prepare(const kinematics::Mechanism& m, const StudyOptions& options);

/// Index of a frame. @throws core::BadInput with what there is
int frame_named(const kinematics::Mechanism& m, const std::string& name);

Json study_json(const StudyTask& task, const std::vector<double>& values, const studies::Statistics& statistics);

}  // namespace trocar::app
