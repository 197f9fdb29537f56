#include "modeller/gesture.hpp"

#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

#include <trocar/core/text.hpp>

namespace trocar::app {

std::optional<double> Gesture::number() const {
  if (typed.empty()) return std::nullopt;
  char* end = nullptr;
  const double value = std::strtod(typed.c_str(), &end);
  if (*end != 0 || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::string Gesture::said(const std::string& amount) const {
  static constexpr const char *words[] = {"Move", "Rotate", "Scale"}, *units[] = {"mm", "degrees", "times"};
  const std::string value = typed.empty() ? amount : fmt::format("{}_ {}", typed, tr(units[int(kind)]));
  if (axis >= 0)
    return tr("{} along {}: {}.   Digits: exact amount   Enter or click: keep   Esc: cancel", tr(words[int(kind)]),
              "xyz"[axis], value);
  return tr("{}: {}.   X Y Z: one axis   digits: exact amount   Enter or click: keep   Esc: cancel",
            tr(words[int(kind)]), value);
}

}  // namespace trocar::app
