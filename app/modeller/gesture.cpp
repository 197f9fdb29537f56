#include "modeller/gesture.hpp"

#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

namespace trocar::app {

std::optional<double> Gesture::number() const {
  if (typed.empty()) return std::nullopt;
  char* end = nullptr;
  const double value = std::strtod(typed.c_str(), &end);
  if (*end != 0 || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::string Gesture::said(const std::string& amount) const {
  static constexpr const char *words[] = {"Move", "Rotate", "Scale"}, *units[] = {" mm", " degrees", ""};
  const std::string along = axis < 0 ? "" : fmt::format(" along {}", "xyz"[axis]);
  const std::string value = typed.empty() ? amount : typed + "_" + units[int(kind)];
  return fmt::format("{}{} {}   X Y Z: one axis   digits: exactly   Enter or click: keep   Esc: take back",
                     words[int(kind)], along, value);
}

}  // namespace trocar::app
