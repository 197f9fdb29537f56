// The program as a script runs it, in this process: words in; exit code and both streams out.
#pragma once

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <trocar/core/json.hpp>

#include "commands/program.hpp"

namespace trocar::app {

struct Outcome {
  int exit = -1;
  std::string out, err;
  Json json() const { return Json::parse(out, nullptr, false); }
};

inline Outcome trocar(std::vector<std::string> words) {
  std::vector<const char*> argv{"trocar"};
  for (const std::string& w : words) argv.push_back(w.c_str());
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  Outcome o;
  o.exit = run_program(int(argv.size()), argv.data());
  o.out = testing::internal::GetCapturedStdout();
  o.err = testing::internal::GetCapturedStderr();
  return o;
}

}  // namespace trocar::app
