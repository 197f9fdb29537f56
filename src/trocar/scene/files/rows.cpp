#include <cmath>

#include <trocar/core/decimal.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/scene/files/rows.hpp>
#include <trocar/vessels/graph.hpp>

namespace trocar::scene {
namespace units {
namespace {
constexpr double kMmHg = vessels::kPascalPerMmHg;
}
const Unit one{[](double v) { return v; }, [](double v) { return v; }};
const Unit mm{[](double v) { return v / 1000; }, [](double v) { return v * 1000; }};
const Unit diameter{[](double v) { return v / 1000 / 2; }, [](double v) { return v * 2000; }};
const Unit deg{[](double v) { return v * portable::pi / 180; }, [](double v) { return v * 180 / portable::pi; }};
const Unit kilo{[](double v) { return v * 1000; }, [](double v) { return v / 1000; }};
const Unit millilitre{[](double v) { return v / 1e6; }, [](double v) { return v * 1e6; }};
const Unit litre{[](double v) { return v / 1000; }, [](double v) { return v * 1000; }};
const Unit mmhg{[](double v) { return v * kMmHg; }, [](double v) { return v / kMmHg; }};
const Unit mmhg_s_ml{[](double v) { return v * (kMmHg * 1e6); }, [](double v) { return v / (kMmHg * 1e6); }};
const Unit ml_mmhg{[](double v) { return v / (kMmHg * 1e6); }, [](double v) { return v * (kMmHg * 1e6); }};
}  // namespace units

double in_file(const Unit& unit, double value) {
  const double guess = unit.guess(value);
  for (int digits = 1; digits <= 17; ++digits) {
    const std::string text = fmt::format("{:.{}e}", guess, digits - 1);
    const double v = core::to_double(text);
    if (unit.read(v) == value) return v;
  }
  for (const double v : {std::nextafter(guess, -1e300), std::nextafter(guess, 1e300)})
    if (unit.read(v) == value) return v;
  return guess;
}

Vec3d read_by(const Unit& unit, Vec3d v) { return {unit.read(v.x), unit.read(v.y), unit.read(v.z)}; }
JsonValue written_by(const Unit& unit, Vec3d v) {
  return json_array(
      {json_number(in_file(unit, v.x)), json_number(in_file(unit, v.y)), json_number(in_file(unit, v.z))});
}

std::string shown_by(const Unit& unit, Vec3d v) {
  return fmt::format("({}, {}, {})", in_file(unit, v.x), in_file(unit, v.y), in_file(unit, v.z));
}

}  // namespace trocar::scene
