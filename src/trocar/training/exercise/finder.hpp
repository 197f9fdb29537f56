// Finds what an exercise names in its scene.
#pragma once

#include <string>
#include <vector>

#include <trocar/sim/model/model.hpp>
#include <trocar/training/exercise/exercise.hpp>

namespace trocar::training {

using Faults = std::vector<core::Fault>;

/// What is not there is a fault at its place in the exercise file.
struct Finder {
  const sim::Model& model;
  Faults& faults;

  int strand(const std::string& name, const core::Location& at) const;
  int organ(const std::string& name, const core::Location& at) const;
  /// As a hold names it; -1 for a fold that is drawn only.
  std::int32_t body(const Named& named) const;
  /// A membrane; -1 for a fold that is drawn only.
  int fold(const std::string& name, const core::Location& at) const;
  /// @param what  kind of instrument, for people: "a grasper"
  void instrument(const std::string& name, const core::Location& at, interactions::ToolKind kind,
                  const char* what) const;
  /// Arc length at which a strand's landmark begins or ends [m].
  double landmark(int strand, const char* name, bool end, const core::Location& at) const;

 private:
  std::vector<std::string> organ_names() const;
};

}  // namespace trocar::training
