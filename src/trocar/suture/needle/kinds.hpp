// Surgical needles by name: how long the wire is, which part of a circle it is bent to, how thick it is.
#pragma once

#include <span>
#include <string>

namespace trocar::suture {

/// Arc length and bend are what needles are sold by; the wire's diameters are our choice, as makers do not print them.
struct NeedleKind {
  const char* name;
  double length;  ///< of the wire's middle line, tip to swage [m]
  double turn;    ///< that it is bent by, over its whole length [rad]; 0: straight
  double wire;    ///< diameter [m]
};

std::span<const NeedleKind> needle_kinds() noexcept;
/// Null where there is none of that name.
const NeedleKind* needle_kind(const std::string& name) noexcept;
/// For messages: "half_26, half_17, ...".
std::string names_of_needles();

}  // namespace trocar::suture
