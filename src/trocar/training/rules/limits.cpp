#include <fmt/format.h>

#include <trocar/training/rules/limits.hpp>

namespace trocar::training {

std::string Limit::shown() const {
  return is_range ? fmt::format("{:g} to {:g}", low, high) : fmt::format("{:g}", low);
}

Limits limits_in(Limits limits, std::string_view anatomy) {
  for (Limit& l : limits)
    for (const Limit::Elsewhere& e : l.elsewhere)
      if (e.anatomy == anatomy) l.low = e.low, l.high = e.high;
  return limits;
}

const Limit* find_limit(const Limits& limits, std::string_view name) {
  for (const Limit& l : limits)
    if (l.name == name) return &l;
  return nullptr;
}

}  // namespace trocar::training
