#include <cmath>

#include <trocar/view/instruments/kind_shapes.hpp>
#include <trocar/view/instruments/metal_parts.hpp>

namespace trocar::view {
namespace {

using namespace metal;

constexpr int kNeedleSides = 12;
constexpr double kPointBevel = 2.6;  // of a point's length to its width

/// A tube from within the shaft to `length` beyond it, ground aslant; along z from the shaft's end.
MeshBuffer hollow_needle(const interactions::NeedleModel& needle) {
  const double r = needle.radius, bore = 0.5 * needle.bore, end = needle.length;
  MeshBuffer b = turned({{-0.002, 0, kClean},
                         {-0.002, r, kClean},
                         {-0.002, r, kClean},
                         {end, r, kClean},
                         {end, r, kClean},
                         {end, bore, kShaded},
                         {end, bore, kHollow},
                         {end - 2 * r, 0, kHollow}},
                        kNeedleSides);
  // The side towards +x ends first.
  for (Vec3f& p : b.positions)
    if (double(p.z) > end - 1e-9) p.z -= float(kPointBevel * (double(p.x) + r));
  return b;
}

/// The shaft narrows to a nozzle that the needle comes out of.
MeshBuffer nozzle(const ToolModel& tool) {
  const double r = tool.shaft_radius, end = tool.jaw_length, lip = 1.9 * tool.needle.radius;
  return turned({{-tool.shaft_length, 0, kClean},
                 {-tool.shaft_length, r, kClean},
                 {-tool.shaft_length, r, kClean},
                 {end - 1.1 * r, r, kClean},
                 {end - 0.8 * r, 0.96 * r, kClean},
                 {end - 0.25 * r, 0.6 * r, kClean},
                 {end - 0.05 * r, 1.2 * lip, kClean},
                 {end, lip, kClean},
                 {end, lip, kShaded},
                 {end, tool.needle.radius, kHollow},
                 {end - 0.001, 0, kHollow}},
                kAround);
}

}  // namespace

std::vector<InstrumentPart> injection_needle_parts(const ToolModel& tool) {
  std::vector<InstrumentPart> parts;
  parts.push_back({PartJoint::body, "steel", nozzle(tool)});
  parts.push_back({PartJoint::needle, "polished_steel", hollow_needle(tool.needle)});
  return parts;
}

}  // namespace trocar::view
