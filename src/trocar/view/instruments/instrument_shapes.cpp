#include <algorithm>
#include <cmath>

#include <trocar/numerics/portable.hpp>
#include <trocar/view/instruments/instrument_shapes.hpp>
#include <trocar/view/instruments/shapes.hpp>

namespace trocar::view {
namespace {

using interactions::ToolKind;
using interactions::ToolModel;
using Joint = InstrumentPart::Joint;

constexpr int kAround = 40;
constexpr double kCollarFrom = -0.0072;  // [m] where a hook's white collar begins
// Blood is what clings there after work, burn what chars there: SceneView says how much of it is on an instrument.
const Paint kClean{255, 0, 0, 0}, kShaded{110, 0, 0, 0}, kHollow{40, 0, 0, 90}, kUsed{235, 190, 0, 0},
    kSmeared{235, 80, 0, 0};
const Paint kJoint{110, 150, 0, 60};
constexpr double kTooth = 0.0011;  // [m] from one cross tooth of a grasper to the next

void merge(MeshBuffer& to, const MeshBuffer& part) { append(to, part, Mat3f::identity(), {}); }

/// A box along z with rounded edges; half extents along x and y.
MeshBuffer beam(Vec3d from, Vec3d to, double half_x, double half_y, double roundness, Paint paint = {}) {
  const Vec3d x{1, 0, 0}, y{0, 1, 0};
  return bar({{from, half_x * x, half_y * y, paint}, {to, half_x * x, half_y * y, paint}}, roundness);
}

/// Blood that stays in a joint: most at the pivot, none a few millimetres off it. @param z from the pivot [m]
Paint stained(double z, double most) {
  const double share = smooth(0.0062, 0.0012, std::fabs(z + 0.0006));
  return {to_byte(1 - 0.3 * share), to_byte(most * share), 0, 0};
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

/// Fork with a rivet that carries two turning jaws; between its cheeks the rod that drives them.
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

/// Root of a jaw, between the fork's cheeks beside its fellow's: an eye around the rivet.
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

/// Tube of the shaft, from the handle's side to `end`.
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

/// Straight sides and round ends between z = from and to.
Outline stadium(double from, double to, double half_width) {
  return [=](double u) {
    const double r = std::min(half_width, 0.45 * (to - from)), low = from + r, high = to - r;
    if (u < 0.4) return Vec3d{0, half_width, low + (high - low) * u / 0.4};
    if (u < 0.5) {
      const double a = portable::pi * (u - 0.4) / 0.1;
      return Vec3d{0, half_width * std::cos(a), high + r * std::sin(a)};
    }
    if (u < 0.9) return Vec3d{0, -half_width, high + (low - high) * (u - 0.5) / 0.4};
    const double a = portable::pi * (1 + (u - 0.9) / 0.1);
    return Vec3d{0, half_width * std::cos(a), low + r * std::sin(a)};
  };
}

/// Jaw of a fenestrated grasper: a frame around a window that one sees through, cross teeth inside, narrow at the hinge
/// and thinner to the tip.
MeshBuffer grasper_jaw(const ToolModel& tool) {
  const double length = tool.jaw_length, half = 0.5 * tool.jaw_width, thick = tool.jaw_thickness;
  const auto neck = [=](double z) { return 0.46 + 0.54 * smooth(0.003, 0.0075, z); };
  const Outline plain = stadium(-0.001, length, half);
  const Outline outer = [=](double u) {
    Vec3d p = plain(u);
    p.y *= neck(p.z);
    return p;
  };
  const Outline window = stadium(0.37 * length, 0.87 * length, 0.52 * half);
  const Height inside = [=](double y, double z) {
    if (z < 0.006) return 0.00006;
    const double phase = z / kTooth - std::floor(z / kTooth);
    const double teeth = 0.00034 * (phase < 0.5 ? 2 * phase : 2 - 2 * phase);
    // They end before the window; at the edge they are lower, and their tops meet when the jaws are closed.
    const double across = std::fabs(y) / (half * neck(z)), edge = smooth(0.8, 0.96, across);
    const double side = 1 - 0.35 * edge - 0.65 * smooth(0.9, 1, z / length);
    return teeth * smooth(0.5, 0.66, across) * side + 0.00012 * (1 - edge) + 0.00001;
  };
  const Height outside = [=](double y, double z) {
    const double across = std::min(1.0, std::fabs(y) / (half * neck(z)));
    const double body = thick * (1.2 - 0.38 * smooth(0.002, 0.3 * length, z) - 0.24 * smooth(0.3 * length, length, z));
    // Milled: a back that is nearly flat, and slants to its edges.
    return body * (1 - 0.06 * across * across - 0.44 * smooth(0.6, 0.98, across));
  };
  MeshBuffer b = plate(outer, window, inside, outside, 208, 6, [=](bool face, double y, double z) {
    const double phase = z / kTooth - std::floor(z / kTooth), deep = phase < 0.5 ? 1 - phase : phase;
    const double works = smooth(0.004, 0.012, z), across = std::fabs(y) / (half * neck(z));
    if (face) return Paint{std::uint8_t(90 + deep * 130), to_byte(works * (1.2 - 0.55 * deep)), 0, 0};
    // Outside it stays in the window's corners, at the teeth and on the tip.
    const bool rim = across < 0.56 && z > 0.36 * length && z < 0.88 * length;
    const double edge = smooth(0.9, 1, across) * (1 - 0.5 * deep), tip = 0.4 * smooth(0.7, 1, z / length);
    const double blood = rim ? 0.42 : std::max({0.62 * works * edge, tip, stained(z, 0.33).blood / 255.0});
    return Paint{to_byte(rim ? 0.6 : 1 - 0.25 * edge), to_byte(blood), 0, 0};
  });
  merge(b, jaw_root(tool.shaft_radius));
  return b;
}

/// White insulation of a bipolar jaw: a tine that leaves the shaft's end beside its fellow, bows away from it, and runs
/// out as the back of the paddle.
MeshBuffer bipolar_tine(const ToolModel& tool) {
  const double length = tool.jaw_length, half = 0.5 * tool.jaw_width, deep = 0.45 * tool.jaw_thickness;
  std::vector<BarSection> sections;
  for (int i = 0; i <= 20; ++i) {
    const double u = i / 20.0, z = -0.0045 + (0.84 * length + 0.0045) * u;
    const double flat = smooth(0.42, 0.62, u), out = 1 - 0.55 * smooth(0.75, 1, u);
    const double thick = (1 - flat) * 0.0008 + flat * 0.00045 * out;
    const double at =
        (1 - flat) * (0.0010 + 0.0005 * std::sin(0.9 * portable::pi * u / 0.5)) + flat * (deep + 0.3 * thick);
    const double wide = (1 - flat) * 0.00085 + flat * 0.74 * half * (1 - 0.3 * smooth(0.85, 1, u));
    sections.push_back({{at, 0, z}, {thick, 0, 0}, {0, wide, 0}, kClean});
  }
  return bar(sections, 0.75);
}

/// The paddle of bipolar forceps: narrow, flat and smooth inside, blunt; its back is insulated nearly to the tip.
MeshBuffer bipolar_paddle(const ToolModel& tool) {
  const double length = tool.jaw_length, half = 0.5 * tool.jaw_width, deep = 0.45 * tool.jaw_thickness;
  const auto works = [](double u) { return Paint{240, to_byte(0.3 * u), to_byte(0.2 + 0.5 * smooth(0.3, 1, u)), 0}; };
  std::vector<BarSection> sections;
  for (int i = 0; i <= 12; ++i) {
    const double u = i / 12.0, z = (0.44 + 0.56 * u) * length;
    const double blunt = std::sqrt(std::max(0.04, 1 - std::pow(std::max(0.0, (u - 0.8) / 0.2), 2)));
    const double wide = (0.5 + 0.18 * smooth(0, 0.4, u)) * half * blunt, thick = deep * (0.8 + 0.2 * blunt);
    sections.push_back({{0.5 * thick + 0.00004, 0, z}, {0.5 * thick, 0, 0}, {0, wide, 0}, works(u)});
  }
  return bar(sections, 0.3);
}

/// A white end on an insulated shaft: ceramic or PTFE from `from` to `end` [m], narrower at its end, which heat has
/// browned.
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

/// The bevel that is ground along a blade's edge: it slants from the outer face to the middle plane.
MeshBuffer ground_edge(const std::vector<BarSection>& blade) {
  constexpr double kBevel = 0.0007;  // [m]
  std::vector<BarSection> sections;
  for (std::size_t i = 4; i < blade.size(); ++i) {
    const BarSection& of = blade[i];
    const double edge = of.centre.x - of.wide.x, inner = of.centre.y - of.deep.y, outer = of.centre.y + of.deep.y;
    const double wide = std::min(kBevel, of.wide.x);
    const Vec3d low{edge - 0.00012, inner + 0.00003, of.centre.z}, high{edge + wide, outer - 0.00004, of.centre.z};
    const Vec3d half = 0.5 * (high - low), out = normalised(Vec3d{-half.y, half.x, 0}, Vec3d{0, 1, 0});
    sections.push_back({0.5 * (low + high), half, 0.00003 * out, kClean});
  }
  return bar(sections, 0.1);
}

/// Blade of curved scissors: a wedge beside the middle plane, both blades bent the same way. @param bend along y [m]
MeshBuffer blade(const ToolModel& tool, double bend) {
  const double length = tool.jaw_length, high = 0.95 * tool.jaw_width, thick = 0.62 * tool.jaw_thickness;
  std::vector<BarSection> sections;
  for (int i = 0; i <= 14; ++i) {
    const double u = i / 14.0, z = -0.0016 + (length + 0.0016) * u;
    const double w = std::max(0.0, z) / length;
    const double back = high * (0.45 + 0.55 * smooth(-0.002, 0.003, z)) * (1 - 0.78 * std::pow(w, 1.6));
    const double edge = -0.00035 * smooth(0, 0.004, z) * (1 - 0.5 * w);
    const double narrow = 1 - 0.45 * w;
    const double shift = bend * w * w;
    const Vec3d centre{0.5 * (back + edge), 0.02e-3 + 0.5 * thick * narrow + shift, z};
    sections.push_back({centre, {0.5 * (back - edge), 0, 0}, {0, 0.5 * thick * narrow, 0}, kUsed});
    sections.back().paint.blood = to_byte(0.32 * std::max(smooth(0.1, 0.6, w), smooth(0.3, 0, w)));
  }
  MeshBuffer b = bar(sections, 0.22);
  merge(b, ground_edge(sections));
  merge(b, jaw_root(tool.shaft_radius));
  return b;
}

/// Jaw of a clip applier: a back with two rails, between which a leg of the clip slides.
MeshBuffer applier_jaw(const ToolModel& tool) {
  const double length = tool.jaw_length, half = 0.5 * tool.jaw_width, thick = tool.jaw_thickness;
  MeshBuffer b;
  const Vec3d x{1, 0, 0}, y{0, 1, 0};
  const auto back = [&](double z, double low, double high, double wide) {
    return BarSection{{0.5 * (low + high), 0, z}, 0.5 * (high - low) * x, wide * y, kClean};
  };
  merge(b, bar({back(-0.009, 0.0002, thick, 0.7 * half), back(-0.003, 0.2 * thick, 1.3 * thick, 0.75 * half),
                back(0.1 * length, 0.3 * thick, 1.45 * thick, 0.72 * half),
                back(0.35 * length, 0.42 * thick, 1.35 * thick, 0.85 * half),
                back(0.8 * length, 0.42 * thick, 1.05 * thick, 0.93 * half),
                back(0.9 * length, 0.42 * thick, 0.95 * thick, 0.93 * half),
                back(0.98 * length, 0.42 * thick, 0.8 * thick, 0.85 * half),
                back(length, 0.42 * thick, 0.62 * thick, 0.6 * half)},
               0.3));
  for (const double side : {-1.0, 1.0}) {
    const double rail = 0.5 * (half - 0.5 * 0.0013), at = side * (half - rail);
    // They are as high as the back nearly everywhere: a seam in the jaw's side would look dotted from afar.
    const auto section = [&](double z, double low, double high) {
      return BarSection{{0.5 * (low + high), at, z}, 0.5 * (high - low) * x, rail * y, kSmeared};
    };
    merge(b, bar({section(0.1 * length, 0.3 * thick, 1.3 * thick), section(0.25 * length, 0.0001, 1.28 * thick),
                  section(0.8 * length, 0.0001, 0.97 * thick), section(0.95 * length, 0.0001, 0.78 * thick),
                  section(0.995 * length, 0.0003, 0.56 * thick)},
                 0.3));
  }
  return b;
}

/// A tube, open at its end: the applier's mouth, the bore of a suction-irrigator.
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

/// A round hole in a tube's side: a dark disc that is bent around it.
MeshBuffer side_hole(double tube_radius, double angle, double z, double radius) {
  MeshBuffer b = turned({{0, radius, kShaded}, {0, 0.8 * radius, kHollow}, {0, 0, kHollow}}, 16);
  const double out = tube_radius + 2e-5;
  for (Vec3f& p : b.positions) {
    const double at = angle + double(p.x) / tube_radius;
    p = {float(out * std::cos(at)), float(out * std::sin(at)), float(z) + p.y};
  }
  return b;
}

/// A tube whose end is the bore, with eight holes of 1 mm around it.
MeshBuffer irrigator_tube(const ToolModel& tool) {
  const double r = tool.shaft_radius, bore = std::max(0.0015, 0.74 * tool.shaft_radius),
               end = tool.jaw_length + 0.5 * tool.jaw_thickness;
  MeshBuffer b = open_shaft(tool, end, std::max(r - bore, 0.2 * r));
  for (int i = 0; i < 8; ++i)
    merge(b, side_hole(r, (i + 0.5 * (i % 2)) * 0.5 * portable::pi, end - (i < 4 ? 0.004 : 0.0075), 0.0005));
  return b;
}

MeshBuffer blunt_rod(const ToolModel& tool) {
  const double r = tool.shaft_radius, tip = tool.jaw_length;
  std::vector<TurnPoint> outline{
      {-tool.shaft_length, 0, kClean}, {-tool.shaft_length, r, kClean}, {-tool.shaft_length, r, kClean}};
  for (int i = 0; i <= 8; ++i) {
    const double a = 0.5 * portable::pi * i / 8;
    outline.push_back({tip - r + r * std::sin(a), i == 8 ? 0 : r * std::cos(a), kClean});
  }
  return turned(outline, kAround);
}

/// A hook's bare wire, bent at its end: the foot looks to where jaws would open. Its end is flattened, and what it is
/// used with is brown and black.
MeshBuffer hook_wire(const ToolModel& tool) {
  constexpr double turn = 0.0011, thin = 0.72;
  const double r = 0.5 * thin * tool.jaw_width, tip = tool.jaw_length - r, foot = 1.03 * tool.shaft_radius;
  const Vec3d x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  const auto used = [](double share) { return Paint{to_byte(1 - 0.1 * share), 0, to_byte(0.75 * share), 0}; };
  std::vector<BarSection> sections{{-0.003 * z, r * x, r * y, kShaded}};
  for (const double u : {0.2, 0.6, 1.0}) sections.push_back({(u * (tip - turn)) * z, r * x, r * y, used(0.6 * u)});
  for (int i = 1; i <= 6; ++i) {
    const double a = 0.5 * portable::pi * i / 6, c = std::cos(a), s = std::sin(a);
    const Vec3d across = c * x - s * z;
    sections.push_back({(turn * (1 - c)) * x + (tip - turn + turn * s) * z, (r * (1 - 0.12 * s)) * across,
                        (r * (1 + 0.1 * s)) * y, used(0.65 + 0.2 * s)});
  }
  sections.push_back({(foot - 0.5 * r) * x + tip * z, -0.8 * r * z, 1.12 * r * y, used(1)});
  sections.push_back({(foot - 0.12 * r) * x + tip * z, -0.66 * r * z, 0.98 * r * y, used(1)});
  sections.push_back({foot * x + tip * z, -0.4 * r * z, 0.7 * r * y, used(1)});
  return bar(sections, 0.8);
}

}  // namespace

std::vector<InstrumentPart> instrument_parts(const ToolModel& tool) {
  std::vector<InstrumentPart> parts;
  switch (tool.kind) {
    case ToolKind::grasper:
      parts.push_back({Joint::body, "insulated", shaft(tool, -0.0098)});
      parts.push_back({Joint::body, "steel", hinge(tool.shaft_radius)});
      parts.push_back({Joint::jaw_a, "steel", grasper_jaw(tool)});
      parts.push_back({Joint::jaw_b, "steel", grasper_jaw(tool)});
      break;
    case ToolKind::scissors:
      parts.push_back({Joint::body, "insulated", shaft(tool, -0.0098)});
      parts.push_back({Joint::body, "steel", hinge(tool.shaft_radius)});
      parts.push_back({Joint::jaw_a, "polished_steel", blade(tool, 0.0016)});
      parts.push_back({Joint::jaw_b, "polished_steel", blade(tool, -0.0016)});
      break;
    case ToolKind::clip_applier:
      parts.push_back({Joint::body, "steel", open_shaft(tool, -0.002, 0.0008)});
      parts.push_back({Joint::jaw_a, "matte_steel", applier_jaw(tool)});
      parts.push_back({Joint::jaw_b, "matte_steel", applier_jaw(tool)});
      break;
    case ToolKind::suction_irrigator:
      parts.push_back({Joint::body, "matte_steel", irrigator_tube(tool)});
      break;
    case ToolKind::probe:
      parts.push_back({Joint::body, "steel", blunt_rod(tool)});
      break;
    case ToolKind::hook:
      parts.push_back({Joint::body, "insulated", shaft(tool, kCollarFrom)});
      parts.push_back({Joint::body, "ceramic", insulator(tool, kCollarFrom, 0, 0.55 * tool.shaft_radius)});
      parts.push_back({Joint::body, "steel", hook_wire(tool)});
      break;
    case ToolKind::bipolar:
      parts.push_back({Joint::body, "insulated", shaft(tool, -0.0105)});
      parts.push_back({Joint::body, "ceramic", insulator(tool, -0.0105, -0.003, 0.92 * tool.shaft_radius)});
      for (const Joint jaw : {Joint::jaw_a, Joint::jaw_b}) {
        parts.push_back({jaw, "ceramic", bipolar_tine(tool)});
        parts.push_back({jaw, "steel", bipolar_paddle(tool)});
      }
      break;
  }
  return parts;
}

std::vector<InstrumentPart> sleeve_parts(double radius, double reach, double from) {
  constexpr double slant = 0.7;
  const double r = radius + kSleeveWall, back = std::min(-0.05, from - 0.02), end = reach - slant * r;
  MeshBuffer b = turned({{back, 0, kShaded},
                         {back, r, kClean},
                         {back, r, kClean},
                         {end - 0.03, r, kClean},
                         {end - 0.0004, r, kClean},
                         {end, r - 0.0003, kClean},
                         {end, r - 0.0003, kClean},
                         {end, radius, kClean},
                         {end, radius, kShaded},
                         {end - 0.012, radius, kHollow},
                         {end - 0.012, 0, kHollow}},
                        kAround);
  for (Vec3f& p : b.positions)
    if (p.z > float(end - 0.02)) p.z += float(slant) * p.x;
  std::vector<InstrumentPart> parts;
  parts.push_back({Joint::body, "sleeve", std::move(b)});
  return parts;
}

std::vector<InstrumentPart> scope_parts(double radius) {
  std::vector<InstrumentPart> parts;
  const double r = radius;
  parts.push_back({Joint::body, "steel",
                   turned({{-0.31, 0, kClean},
                           {-0.31, r, kClean},
                           {-0.31, r, kClean},
                           {-0.0006, r, kClean},
                           {0, 0.92 * r, kClean},
                           {0, 0.92 * r, kClean},
                           {0, 0.5 * r, kClean},
                           {0, 0.5 * r, kHollow},
                           {-0.001, 0.48 * r, kHollow},
                           {-0.001, 0, kHollow}},
                          kAround)});
  return parts;
}

Placement placement_of(Joint joint, const interactions::ToolShape& shape) {
  const Vec3d axis = shape.frame.axis(), open = shape.frame.opening();
  const double side = joint == Joint::jaw_b ? -1 : 1;
  Vec3d x = side * open, z = axis, origin = shape.pivot;
  if (joint != Joint::body) {
    const double c = 1 / std::sqrt(1 + shape.tangent * shape.tangent), s = c * shape.tangent;
    z = c * axis + (side * s) * open;
    x = side * (c * open) - s * axis;
    origin += (side * shape.half_gap) * open;
  }
  const Vec3d y = cross(z, x);
  return {Mat3f::from_columns(vec_cast<float>(x), vec_cast<float>(y), vec_cast<float>(z)), vec_cast<float>(origin)};
}

double aperture_in_sleeve(const ToolModel& tool, double beyond, double radius) {
  // The space for a jaw's back, at the sleeve's end or at the jaw's.
  const double along = std::min(beyond, tool.jaw_length), space = radius - 1.25 * tool.jaw_thickness;
  if (along <= 0) return 1;
  const double half_angle = std::atan2(std::max(0.0, space), along), half_gap = std::max(0.0, space);
  double aperture = 1;
  if (tool.opening > 0) aperture = std::min(aperture, 2 * half_angle / tool.opening);
  if (tool.parallel_gap > 0) aperture = std::min(aperture, 2 * half_gap / tool.parallel_gap);
  return aperture;
}

double clip_seat(const ToolModel& tool) { return tool.jaw_length - tool.clip_length; }

}  // namespace trocar::view
