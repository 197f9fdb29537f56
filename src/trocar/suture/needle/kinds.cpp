#include <trocar/numerics/portable.hpp>
#include <trocar/suture/needle/kinds.hpp>

namespace trocar::suture {
namespace {

constexpr double kPi = portable::pi;
constexpr NeedleKind kNeedles[] = {
    {"half_26", 0.026, kPi, 0.00065},
    {"half_17", 0.017, kPi, 0.00045},
    {"half_37", 0.037, kPi, 0.00095},
    {"three_eighths_19", 0.019, 0.75 * kPi, 0.00050},
    {"three_eighths_26", 0.026, 0.75 * kPi, 0.00065},
    {"five_eighths_26", 0.026, 1.25 * kPi, 0.00065},
    {"straight_60", 0.060, 0, 0.00075},
};

}  // namespace

std::span<const NeedleKind> needle_kinds() noexcept { return kNeedles; }

const NeedleKind* needle_kind(const std::string& name) noexcept {
  for (const NeedleKind& kind : kNeedles)
    if (name == kind.name) return &kind;
  return nullptr;
}

std::string names_of_needles() {
  std::string all;
  for (const NeedleKind& kind : kNeedles) all += (all.empty() ? "" : ", ") + std::string(kind.name);
  return all;
}

}  // namespace trocar::suture
