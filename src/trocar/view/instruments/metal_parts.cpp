#include <algorithm>
#include <cmath>

#include <trocar/view/instruments/metal_parts.hpp>

namespace trocar::view::metal {
namespace {

/// A box along z with rounded edges; half extents along x and y.
MeshBuffer beam(Vec3d from, Vec3d to, double half_x, double half_y, double roundness, Paint paint = {}) {
  const Vec3d x{1, 0, 0}, y{0, 1, 0};
  return bar({{from, half_x * x, half_y * y, paint}, {to, half_x * x, half_y * y, paint}}, roundness);
}

/// The ring around a rivet's head, where blood dries, and the head, slightly domed; +y and -y alike.
MeshBuffer rivet(double radius, double cheek, double half_length) {
  const Paint ring{70, 215, 0, 90};
  MeshBuffer b;
  for (const double side : {-1.0, 1.0}) {
    const MeshBuffer upright = turned({{cheek, 0, ring},
                                       {cheek, 1.36 * radius, ring},
                                       {cheek + 0.00005, 1.3 * radius, ring},
                                       {cheek + 0.00005, radius, ring},
                                       {cheek + 0.00005, radius, kClean},
                                       {half_length - 0.00006, radius, kClean},
                                       {half_length, 0.84 * radius, kClean},
                                       {half_length + 0.00005, 0.45 * radius, kClean},
                                       {half_length + 0.00006, 0, kClean}},
                                      18);
    append(b, upright, Mat3f::from_columns({0, 0, 1}, {float(side), 0, 0}, {0, float(side), 0}), {});
  }
  return b;
}

}  // namespace

void merge(MeshBuffer& to, const MeshBuffer& part) { append(to, part, Mat3f::identity(), {}); }

Paint stained(double z, double most) {
  const double share = smooth(0.0062, 0.0012, std::fabs(z + 0.0006));
  return {to_byte(1 - 0.3 * share), to_byte(most * share), 0, 0};
}

MeshBuffer hinge(double radius) {
  MeshBuffer b;
  const double cheek = 0.19 * radius, at = 0.64 * radius, wide = 0.56 * radius;
  merge(b, turned({{-0.0105, radius * 0.99, kClean},
                   {-0.0105, radius * 0.99, kClean},
                   {-0.0093, radius * 0.99, kClean},
                   {-0.0091, radius * 0.94, kShaded},
                   {-0.0089, radius * 0.99, kClean},
                   {-0.0068, radius * 0.99, kClean},
                   {-0.0058, radius * 0.86, kClean},
                   {-0.0058, radius * 0.86, kJoint},
                   {-0.0058, 0, kJoint}},
                  kAround));
  for (const double side : {-1.0, 1.0}) {
    const Vec3d x{1, 0, 0}, y{0, 1, 0};
    std::vector<BarSection> sections;
    for (const double z : {-0.0075, -0.0055, -0.0040, -0.0028, -0.0016, -0.0006, 0.0003, 0.0009, 0.0013, 0.0016}) {
      // Straight behind the rivet, round before it.
      const double round = std::sqrt(std::max(0.03, 1 - std::pow(std::max(0.0, z + 0.0002) / 0.0018, 2)));
      sections.push_back({{0, side * at, z}, wide * round * x, cheek * y, stained(z, 0.33)});
    }
    merge(b, bar(sections, 0.12));
  }
  merge(b, beam({0, 0, -0.0075}, {0, 0, -0.0022}, 0.26 * radius, 0.36 * radius, 0.3, kJoint));
  merge(b, rivet(0.3 * radius, at + cheek, 0.93 * radius));
  return b;
}

MeshBuffer jaw_root(double radius) {
  MeshBuffer b;
  const double from = 0.02 * radius, to = 0.42 * radius, eye = 0.5 * radius;
  const MeshBuffer upright = turned({{from, 0, kJoint},
                                     {from, eye, kJoint},
                                     {from, eye, kJoint},
                                     {to, eye, kJoint},
                                     {to, eye, kJoint},
                                     {to, 0, kJoint}},
                                    20);
  append(b, upright, Mat3f::from_columns({0, 0, 1}, {1, 0, 0}, {0, 1, 0}), {});
  const double middle = 0.5 * (from + to);
  merge(b, beam({0.0004, middle, -0.0008}, {0.0008, middle, 0.0015}, 0.0005, middle - from, 0.4, kJoint));
  return b;
}

MeshBuffer shaft(const ToolModel& tool, double end) {
  const double r = tool.shaft_radius, back = -tool.shaft_length;
  return turned({{back, 0, kClean},
                 {back, r, kClean},
                 {back, r, kClean},
                 {end - 0.0004, r, kClean},
                 {end, r - 0.0004, kClean},
                 {end, r - 0.0004, kClean},
                 {end, 0, kShaded}},
                kAround);
}

MeshBuffer open_shaft(const ToolModel& tool, double end, double wall) {
  const double r = tool.shaft_radius, back = -tool.shaft_length;
  return turned({{back, 0, kClean},
                 {back, r, kClean},
                 {back, r, kClean},
                 {end - 0.0005, r, kClean},
                 {end, r - 0.0003, kClean},
                 {end, r - 0.0003, kClean},
                 {end, r - wall, kClean},
                 {end, r - wall, kShaded},
                 {end - 0.008, r - wall, kHollow},
                 {end - 0.008, 0, kHollow}},
                kAround);
}

MeshBuffer insulator(const ToolModel& tool, double from, double end, double end_radius) {
  const double r = 0.97 * tool.shaft_radius, step = end - 0.4 * (end - from);
  const Paint browned{225, 0, 140, 0}, sooted{190, 30, 210, 0};
  return turned({{from, 0, kShaded},
                 {from, r, kShaded},
                 {from, r, kShaded},
                 {from + 0.0003, r, kClean},
                 {step - 0.0002, r, kClean},
                 {step, r - 0.0002, kClean},
                 {step + 0.3 * (end - step), end_radius + 0.3 * (r - end_radius), kClean},
                 {step + 0.6 * (end - step), end_radius + 0.0003, browned},
                 {end - 0.0005, end_radius + 0.0002, sooted},
                 {end, end_radius - 0.0002, sooted},
                 {end, end_radius - 0.0002, sooted},
                 {end, 0, kShaded}},
                kAround);
}

}  // namespace trocar::view::metal
