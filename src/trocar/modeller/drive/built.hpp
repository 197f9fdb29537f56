// A document compiled: what can be drawn, stepped and told about, or every reason why it cannot.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <trocar/core/error.hpp>
#include <trocar/modeller/document/document.hpp>
#include <trocar/modeller/drive/readiness.hpp>
#include <trocar/scene/compile/compile.hpp>

namespace trocar::modeller {

struct Built {
  std::uint64_t version = 0;  ///< of the document
  std::vector<core::Fault> faults;
  std::unique_ptr<sim::Model> model;  ///< null where there are faults
  scene::CompileReport report;
  std::vector<std::string> notes;  ///< what was made up so that there is something to look at
  std::vector<Finding> findings;   ///< what it lacks to be operated on
  double seconds = 0;              ///< that it took

  bool good() const { return model != nullptr; }
};

/// Reads and compiles the document as it is edited. Never throws: what is wrong is in `faults`. Organs and pouches that
/// nothing holds yet are held by their middle, and noted: they can be looked at, not operated on.
Built build(const Document& document);

/// What a body costs and is: a line of the read-outs.
struct ReadOut {
  std::string name, kind;
  int nodes = 0, springs = 0, substeps = 0;
  double volume_mL = 0, mass_g = 0, limit_ms = 0, off_mm = -1;  ///< off: farthest from where it is drawn, < 0 unknown
  double predicted_us = 0;                                      ///< of a tick, on a quiet core
  std::size_t bytes = 0;                                        ///< in memory (body_memory.hpp)
};
/// @param standing_ticks  simulated to check the equilibrium; 0: not checked
std::vector<ReadOut> read_outs(const Built& built, std::uint64_t standing_ticks);

}  // namespace trocar::modeller
