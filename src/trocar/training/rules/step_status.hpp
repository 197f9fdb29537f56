// How far one step of an attempt has come.
#pragma once

#include <string>
#include <vector>

namespace trocar::training {

struct StepStatus {
  std::string name, hint;  ///< the hint with a keyboard's keys
  std::string task;        ///< as the file names it: "survey", "identify" ...
  std::string side;        ///< element of the step's set: "left"; empty for a step that is there once
  bool done = false;
  bool missed = false;  ///< can no longer be done
  bool optional = false;
  double at = 0;                  ///< when it was done or missed [s]
  std::string hint_pattern = {};  ///< with {key:...}, for who shows it on another device (core::with_keys())
};

/// An exercise's steps in the order in which they are shown.
using Steps = std::vector<StepStatus>;

}  // namespace trocar::training
