#include <algorithm>
#include <cmath>

#include <trocar/interactions/instrument/linkage_works.hpp>
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

namespace {

using interactions::LinkageWorks;

constexpr double kBarFlat = 0.6;  // of a round rod's thickness across the fork: bars are flat there

/// A rod with round ends. @param thick  along y, as a share of what it is across that
MeshBuffer rod_between(const interactions::WorksRod& rod, double thick) {
  constexpr int kSteps = 5, kSides = 20;
  const double length = trocar::length(rod.b - rod.a), r = rod.radius;
  std::vector<TurnPoint> outline;
  for (int end = 0; end < 2; ++end)
    for (int i = 0; i <= kSteps; ++i) {
      const double a = 0.5 * portable::pi * (end == 0 ? 1 - double(i) / kSteps : double(i) / kSteps);
      const bool pole = (end == 0) == (i == 0) && (i == 0 || i == kSteps);
      outline.push_back({end == 0 ? -r * std::sin(a) : length + r * std::sin(a), pole ? 0 : r * std::cos(a), kClean});
    }
  const MeshBuffer upright = turned(outline, kSides);
  const Vec3d z = length > 0 ? (rod.b - rod.a) / length : Vec3d{0, 0, 1};
  const Vec3d off = Vec3d{0, 1, 0} - z.y * z;
  const Vec3d y = trocar::length(off) > 0.1 ? normalised(off) : any_perpendicular(z);
  MeshBuffer b;
  append(b, upright, Mat3f::from_columns(vec_cast<float>(cross(y, z)), vec_cast<float>(thick * y), vec_cast<float>(z)),
         vec_cast<float>(rod.a));
  return b;
}

/// Across the fork, with a head on either side.
MeshBuffer pin(Vec3d at, double radius, double half_length) {
  const MeshBuffer upright = turned({{-half_length, 0, kJoint},
                                     {-half_length, radius, kJoint},
                                     {-half_length, radius, kClean},
                                     {half_length, radius, kClean},
                                     {half_length, radius, kJoint},
                                     {half_length, 0, kJoint}},
                                    16);
  MeshBuffer b;
  append(b, upright, Mat3f::from_columns({0, 0, 1}, {1, 0, 0}, {0, 1, 0}), vec_cast<float>(at));
  return b;
}

/// What moves as one: rods, and pins where it meets others. A rod along the shaft ends inside that.
MeshBuffer works_part(const LinkageWorks::Part& part, double radius, double shaft_end) {
  MeshBuffer b;
  for (interactions::WorksRod rod : part.rods) {
    const bool along = std::fabs(rod.b.x - rod.a.x) < 1e-9 && std::fabs(rod.a.y) < 1e-9;
    for (Vec3d* end : {&rod.a, &rod.b})
      if (along) end->z = std::max(end->z, -shaft_end - 0.012);
    merge(b, rod_between(rod, along ? 1 : kBarFlat));
  }
  for (const Vec3d& at : part.pins) merge(b, pin({at.x, 0, at.z}, 0.16 * radius, 0.58 * radius));
  return b;
}

/// Of a jaw: a flat piece from the hinge back to where the linkage takes hold of it. In the jaw's own frame.
MeshBuffer tail_of(const LinkageWorks::Tail& tail, double radius) {
  constexpr double kTailFlat = 0.42;
  const double side = tail.jaw == 0 ? 1 : -1, y = 0.16 * radius, wide = 0.24 * radius;
  const auto own = [&](Vec3d p) { return Vec3d{side * p.x, y, p.z}; };
  MeshBuffer b = rod_between({{0, y, 0}, own(tail.open), wide}, kTailFlat);
  if (trocar::length(tail.closed - tail.open) > 1e-6)
    merge(b, rod_between({own(tail.open), own(tail.closed), wide}, kTailFlat));
  return b;
}

/// Two cheeks from the shaft's end to the hinge, apart far enough for bars and tails between them.
MeshBuffer long_fork(double radius, double shaft_end) {
  MeshBuffer b;
  const double at = 0.76 * radius, thick = 0.13 * radius, wide = 0.45 * radius;
  merge(b, turned({{-shaft_end - 0.0006, radius * 0.99, kClean},
                   {-shaft_end - 0.0006, radius * 0.99, kClean},
                   {-shaft_end, radius * 0.94, kClean},
                   {-shaft_end, radius * 0.94, kHollow},
                   {-shaft_end, 0, kHollow}},
                  kAround));
  for (const double side : {-1.0, 1.0}) {
    const Vec3d x{1, 0, 0}, y{0, 1, 0};
    std::vector<BarSection> sections;
    for (const double z :
         {-shaft_end - 0.0004, -0.8 * shaft_end, -0.4 * shaft_end, -0.0016, -0.0006, 0.0003, 0.0009, 0.0013, 0.0016}) {
      const double round = std::sqrt(std::max(0.03, 1 - std::pow(std::max(0.0, z + 0.0002) / 0.0018, 2)));
      sections.push_back({{0, side * at, z}, wide * round * x, thick * y, stained(z, 0.33)});
    }
    merge(b, bar(sections, 0.12));
  }
  merge(b, rivet(0.3 * radius, at + thick, 0.93 * radius));
  return b;
}

}  // namespace

void add_hinge(std::vector<InstrumentPart>& parts, const ToolModel& tool) {
  const double radius = tool.shaft_radius;
  if (!tool.works || tool.bends.bends()) {
    parts.push_back({PartJoint::body, "insulated", shaft(tool, kHingeFrom)});
    parts.push_back({PartJoint::body, "steel", hinge(radius)});
    return;
  }
  const LinkageWorks& works = *tool.works;
  parts.push_back({PartJoint::body, "insulated", shaft(tool, -works.shaft_end)});
  parts.push_back({PartJoint::body, "steel", long_fork(radius, works.shaft_end)});
  for (std::size_t k = 0; k < works.parts.size(); ++k)
    parts.push_back({PartJoint::works, "steel", works_part(works.parts[k], radius, works.shaft_end), int(k)});
  for (const LinkageWorks::Tail& tail : works.tails)
    parts.push_back({tail.jaw == 0 ? PartJoint::jaw_a : PartJoint::jaw_b, "steel", tail_of(tail, radius)});
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
