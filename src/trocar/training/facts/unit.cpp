#include <trocar/numerics/portable.hpp>
#include <trocar/training/facts/unit.hpp>

namespace trocar::training {
namespace {

constexpr Unit kUnits[] = {
    {"", 1, "a plain number"},
    {"mL_min", 1e-6 / 60, "millilitres a minute"},
    {"per_min", 1.0 / 60, "times a minute"},
    {"mm_s", 1e-3, "millimetres a second"},
    {"N_s", 1, "newton seconds"},
    {"mm2", 1e-6, "square millimetres"},
    {"mm", 1e-3, "millimetres"},
    {"mL", 1e-6, "millilitres"},
    {"IU", 1, "international units"},
    {"deg", portable::pi / 180, "degrees"},
    {"N", 1, "newtons"},
    {"s", 1, "seconds"},
    {"C", 1, "degrees Celsius"},
};

}  // namespace

std::span<const Unit> units() { return kUnits; }

const Unit& unit_of(std::string_view name) {
  for (const Unit& unit : units().subspan(1)) {
    const std::size_t n = unit.suffix.size();
    if (name.size() > n + 1 && name.ends_with(unit.suffix) && name[name.size() - n - 1] == '_') return unit;
  }
  return kUnits[0];
}

}  // namespace trocar::training
