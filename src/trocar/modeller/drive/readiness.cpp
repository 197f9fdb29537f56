#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/geometry/surface_files/unit_guess.hpp>
#include <trocar/kinematics/fulcrum.hpp>
#include <trocar/modeller/document/outline.hpp>
#include <trocar/modeller/document/plain_words.hpp>
#include <trocar/modeller/drive/readiness.hpp>
#include <trocar/modeller/materials/materials.hpp>
#include <trocar/modeller/operations/body_mesh.hpp>
#include <trocar/modeller/operations/values.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/scene/files/library.hpp>
#include <trocar/scene/json/json_text.hpp>

namespace trocar::modeller {
namespace {

using scene::JsonValue;
using About = Finding::About;

constexpr double kNearest = 0.02;   // [m] a body nearer than this to the lens fills the picture with a blur
constexpr double kFarthest = 0.25;  // [m] at which an endoscope still shows something
constexpr double kUsualDistance = 0.12, kClearOfTips = 0.085;  // [m] from the lens
constexpr double kLeastShare = 0.05;                           // of a body's surface that has to be in the picture
constexpr double kUsualOrgan = 0.1;                            // [m] longest side
constexpr double kWidestHold = 0.5;                            // [m] radius: the widest of scene files
constexpr std::array kRests = {1.0 / 3, 0.5, 2.0 / 3};         // shares of a body that rests on its underside

JsonValue step_named(const char* name) {
  JsonValue step = scene::json_object();
  scene::put(step, "do", scene::json_text(name));
  return step;
}

JsonValue list_of_one(const std::string& thing) { return scene::json_array({scene::json_text(thing)}); }

/// A body of the document, as far as checks need it.
struct Checked {
  Thing thing;
  geometry::TriMesh mesh;  ///< [m]
  scene::Anchor hold;
  bool attached = false;

  geometry::Bounds box() const { return geometry::bounds(mesh.positions); }
  std::string id() const { return thing.kind + ":" + thing.name; }
};

/// Those of the user's own files: what the program brings along is taken to be well.
std::vector<Checked> checked_bodies(const Document& document, const scene::Description& d) {
  std::vector<Checked> out;
  const bool is_installed = scene::name_in_installed_scenes(document.root()).has_value();
  const std::vector<Thing> things = outline(document);
  const auto add = [&](const auto& body, const char* kind) {
    for (const Thing& thing : things) {
      if (thing.kind != kind || thing.name != body.name) continue;
      if (!is_installed && scene::name_in_installed_scenes(thing.file)) continue;
      Checked one{thing, surface_mesh(body), {}, is_attached(body)};
      if (one.mesh.triangles.empty()) continue;
      one.hold = middle_hold(body);
      out.push_back(std::move(one));
    }
  };
  for (const scene::Solid& solid : d.solids) add(solid, "solid");
  for (const scene::Pouch& pouch : d.pouches) add(pouch, "pouch");
  return out;
}

JsonValue hold_step(const std::string& body, const scene::Anchor& hold) {
  JsonValue step = step_named("hold");
  scene::put(step, "of", scene::json_text(body));
  scene::put(step, "centre_mm", point(hold.centre * 1e3));
  scene::put(step, "radius_mm", number(std::max(0.1, hold.radius * 1e3)));
  return step;
}

void check_attachment(const Checked& body, std::vector<Finding>& out) {
  if (body.attached) return;
  out.push_back({About::attachment,
                 body.id(),
                 tr("{} is not attached: it would fall.", body.thing.name),
                 tr("Attach here"),
                 {hold_step(body.id(), body.hold)}});
}

void check_size(const Document& document, const Checked& body, std::vector<Finding>& out) {
  const double volume = std::fabs(geometry::volume(body.mesh));
  if (volume >= kLeastOrgan && volume <= kMostOrgan) return;
  const Vec3d size = body.box().high - body.box().low;
  const double longest = std::max({size.x, size.y, size.z});
  Finding finding{About::size,
                  body.id(),
                  tr("{} is {:.3g} mm long and holds {:.3g} mL. Organs hold 0.1 mL to 20 L.", body.thing.name,
                     1e3 * longest, 1e6 * volume),
                  "",
                  {}};
  if (const double by = scale_to_organ(longest); by != 1) {
    finding.remedy = tr("Scale to {:.0f} mm", 1e3 * longest * by);
    JsonValue scale = step_named("scale");
    scene::put(scale, "of", list_of_one(body.id()));
    scene::put(scale, "by", scene::json_number(by));
    const Vec3d middle = (body.box().low + body.box().high) / 2.0;
    scene::put(scale, "about_mm", point(middle * 1e3));
    finding.steps.push_back(std::move(scale));
    for (const char* key : {"cell_mm", "spacing_mm"}) {
      const double length = number_in(value_of(document, body.thing), key, 0);
      if (length <= 0) continue;
      JsonValue cell = step_named("set");
      scene::put(cell, "of", scene::json_text(body.id()));
      scene::put(cell, "key", scene::json_text(key));
      scene::put(cell, "value", number(std::clamp(length * by, 0.1, 100.0)));
      finding.steps.push_back(std::move(cell));
    }
  }
  out.push_back(std::move(finding));
}

/// The endoscope at the start; none where its port is not there.
std::optional<kinematics::ScopeFrame> lens_of(const scene::Description& d) {
  const scene::Placement& scope = d.scope_placement;
  for (const scene::Port& port : d.ports)
    if (port.name == scope.port)
      return kinematics::scope_frame(port.position, kinematics::inverse(port.position, scope.tip, scope.roll),
                                     d.scope.angle, 0);
  return std::nullopt;
}

/// What the lens has of a body: the share of its surface in the picture, and how near it comes.
struct InPicture {
  double share = 0, nearest = 1e9;
};
InPicture in_picture(const kinematics::ScopeFrame& lens, double field, const geometry::TriMesh& mesh) {
  InPicture out;
  const double cone = portable::cos(field / 2);
  std::size_t seen = 0;
  for (const Vec3d& p : mesh.positions) {
    const Vec3d way = p - lens.eye;
    const double distance = length(way);
    out.nearest = std::min(out.nearest, distance);
    seen += distance > 0 && distance < kFarthest && dot(way, lens.forward) > cone * distance;
  }
  out.share = double(seen) / double(std::max<std::size_t>(1, mesh.positions.size()));
  return out;
}

void check_view(const scene::Description& d, const std::vector<Checked>& bodies, std::vector<Finding>& out) {
  const std::optional<kinematics::ScopeFrame> lens = lens_of(d);
  if (!lens || bodies.empty()) return;
  bool any = false;
  for (const Checked& body : bodies) {
    const InPicture p = in_picture(*lens, d.scope.field_of_view, body.mesh);
    any = any || (p.share >= kLeastShare && p.nearest >= kNearest);
  }
  if (any) return;
  const Checked& body = *std::max_element(bodies.begin(), bodies.end(), [](const Checked& a, const Checked& b) {
    return std::fabs(geometry::volume(a.mesh)) < std::fabs(geometry::volume(b.mesh));
  });
  const InPicture p = in_picture(*lens, d.scope.field_of_view, body.mesh);
  const geometry::Bounds box = body.box();
  Finding finding{About::view,
                  body.id(),
                  p.nearest < kNearest ? tr("{} is {:.0f} mm from the endoscope: nothing else is in the picture.",
                                            body.thing.name, 1e3 * p.nearest)
                                       : tr("The endoscope does not see {}.", body.thing.name),
                  "",
                  {}};
  if (const std::optional<Vec3d> to = place_in_view(d, box.high - box.low)) {
    JsonValue step = step_named("move");
    JsonValue names = scene::json_array();
    for (const Checked& each : bodies) names.items.push_back(scene::json_text(each.id()));
    scene::put(step, "of", std::move(names));
    scene::put(step, "by_mm", point((*to - (box.low + box.high) / 2.0) * 1e3));
    finding.remedy = tr("Bring into view");
    finding.steps.push_back(std::move(step));
  }
  out.push_back(std::move(finding));
}

void check_tissues(const Document& document, std::vector<Finding>& out) {
  const std::vector<TissueChoice> known = tissue_choices(document);
  const auto is_known = [&known](const std::string& name) {
    return std::any_of(known.begin(), known.end(), [&name](const TissueChoice& t) { return t.name == name; });
  };
  for (const Thing& thing : outline(document)) {
    if (thing.kind != "solid" && thing.kind != "pouch") continue;
    const JsonValue value = value_of(document, thing);
    const scene::JsonMember* tissue = value.find("tissue");
    if (tissue && is_known(tissue->value.text)) continue;
    out.push_back({About::tissue,
                   thing.kind + ":" + thing.name,
                   tissue ? tr("The tissue \"{}\" of {} is not known.", tissue->value.text, thing.name)
                          : tr("{} has no tissue.", thing.name),
                   tr("Choose tissue"),
                   {}});
  }
}

/// Surfaces that are not to be mended, and have faults because of it.
void check_surfaces(const Document& document, const std::vector<core::Fault>& faults, std::vector<Finding>& out) {
  for (const Thing& thing : outline(document)) {
    const JsonValue value = value_of(document, thing);
    const scene::JsonMember* surface = value.find("surface");
    const scene::JsonMember* mend = surface ? surface->value.find("mend") : nullptr;
    if (!mend || mend->value.truth) continue;
    const bool faulty = std::any_of(faults.begin(), faults.end(), [&](const core::Fault& f) {
      return whole_path(f.at.file) == thing.file && f.message.find("closed surface") != std::string::npos;
    });
    if (!faulty) continue;
    JsonValue step = step_named("set");
    scene::put(step, "of", scene::json_text(thing.kind + ":" + thing.name));
    scene::put(step, "key", scene::json_text("surface/mend"));
    scene::put(step, "value", scene::json_flag(true));
    out.push_back({About::surface,
                   thing.kind + ":" + thing.name,
                   tr("The surface of {} is not closed.", thing.name),
                   tr("Close holes"),
                   {std::move(step)}});
  }
}

/// The ball that rests a body on that share of its extent along gravity. Its surface is all but flat there.
scene::Anchor underside(const geometry::Bounds& box, Vec3d gravity, double share) {
  const Vec3d down = length(gravity) > 0 ? normalised(gravity) : Vec3d{0, 0, -1};
  const Vec3d size = box.high - box.low;
  const double deep = std::fabs(down.x) * size.x + std::fabs(down.y) * size.y + std::fabs(down.z) * size.z;
  scene::Anchor anchor;
  anchor.radius = kWidestHold;
  anchor.centre = (box.low + box.high) / 2.0 + down * (kWidestHold + (0.5 - share) * deep);
  return anchor;
}

double share_held(const geometry::TriMesh& mesh, const std::vector<scene::Anchor>& anchors) {
  std::size_t held = 0;
  for (const Vec3d& p : mesh.positions)
    held += std::any_of(anchors.begin(), anchors.end(),
                        [&p](const scene::Anchor& a) { return length(p - a.centre) < a.radius; });
  return double(held) / double(std::max<std::size_t>(1, mesh.positions.size()));
}

/// Solids whose attachments cannot carry them rest on their underside, more of it with each click.
void check_support(const Document& document, const scene::Description& d, const std::vector<core::Fault>& faults,
                   std::vector<Finding>& out) {
  for (const Thing& thing : outline(document)) {
    const auto solid =
        std::find_if(d.solids.begin(), d.solids.end(), [&](const scene::Solid& s) { return s.name == thing.name; });
    if (thing.kind != "solid" || solid == d.solids.end()) continue;
    const bool falls = std::any_of(faults.begin(), faults.end(), [&](const core::Fault& f) {
      return f.message.find("'" + thing.name + "' to be held against gravity") != std::string::npos;
    });
    if (!falls) continue;
    Finding finding{About::attachment,
                    "solid:" + thing.name,
                    tr("{} is too heavy for what it is attached by.", thing.name),
                    "",
                    {}};
    const geometry::TriMesh mesh = surface_mesh(*solid);
    const double held = share_held(mesh, solid->anchors);
    const auto share = std::find_if(kRests.begin(), kRests.end(), [held](double s) { return held < 0.9 * s; });
    if (share != kRests.end() && !mesh.triangles.empty()) {
      const scene::Anchor rest = underside(geometry::bounds(mesh.positions), d.gravity, *share);
      finding.remedy = tr("Rest it on its underside");
      finding.steps.push_back(hold_step(finding.thing, rest));
    }
    out.push_back(std::move(finding));
  }
}

bool has_organ(const scene::Description& d) {
  return !d.solids.empty() || !d.pouches.empty() || !d.strands.empty() || !d.membranes.empty();
}

/// The place of a body's surface nearest to its middle where that is outside, as in a bent tube.
Vec3d inside_near_middle(const geometry::TriMesh& mesh, const geometry::Bounds& box) {
  const Vec3d middle = (box.low + box.high) / 2.0;
  if (mesh.triangles.empty()) return middle;
  const Foot foot = nearest_foot(mesh, middle);
  return dot(middle - foot.at, foot.normal) <= 0 ? middle : foot.at;
}

/// Holds a quarter of a body of sections.
scene::Anchor ball_in(const std::vector<scene::Section>& sections, double cell) {
  const scene::Section& middle = sections[sections.size() / 2];
  scene::Anchor anchor;
  anchor.centre = middle.centre;
  anchor.radius = 0.6 * std::max(length(middle.across), length(middle.deep)) + 1.5 * cell;
  return anchor;
}

}  // namespace

scene::Anchor hold_in_middle(const geometry::TriMesh& mesh, double cell) {
  const geometry::Bounds box = geometry::bounds(mesh.positions);
  const Vec3d size = box.high - box.low;
  scene::Anchor anchor;
  anchor.centre = inside_near_middle(mesh, box);
  anchor.radius = 0.35 * std::min({size.x, size.y, size.z}) + 1.5 * cell;
  return anchor;
}

bool is_attached(const scene::Solid& solid) { return !solid.anchors.empty(); }
bool is_attached(const scene::Pouch& pouch) { return pouch.free || !pouch.held.empty(); }

scene::Anchor middle_hold(const scene::Solid& solid) {
  return solid.sections.empty() ? hold_in_middle(surface_mesh(solid), solid.cell) : ball_in(solid.sections, solid.cell);
}
scene::Anchor middle_hold(const scene::Pouch& pouch) {
  return pouch.sections.empty() ? hold_in_middle(surface_mesh(pouch), pouch.spacing)
                                : ball_in(pouch.sections, pouch.spacing);
}

double scale_to_organ(double longest) {
  if (!(longest > 0)) return 1;
  double best = 1, off = 1e9;
  for (const double by : {1.0, 1e-3, 1e-2, 0.1, 10.0, 100.0, 1e3}) {
    const double here = std::fabs(std::log(longest * by / kUsualOrgan));
    if (here < off) off = here, best = by;
  }
  return best;
}

std::optional<Vec3d> place_in_view(const scene::Description& description, Vec3d size) {
  const std::optional<kinematics::ScopeFrame> lens = lens_of(description);
  if (!lens) return std::nullopt;
  const Vec3d f = lens->forward;
  const double half = 0.5 * (std::fabs(f.x) * size.x + std::fabs(f.y) * size.y + std::fabs(f.z) * size.z);
  return lens->eye + f * std::max(kUsualDistance, kClearOfTips + half);
}

std::vector<Finding> readiness(const Document& document, const scene::Description* description,
                               const std::vector<core::Fault>& faults) {
  std::vector<Finding> out;
  check_tissues(document, out);
  check_surfaces(document, faults, out);
  if (description) check_support(document, *description, faults, out);
  if (out.empty() && !faults.empty()) out.push_back({About::file, "", fault_in_words(faults.front()), "", {}});
  if (!description || !faults.empty()) return out;
  if (!has_organ(*description)) {
    out.push_back({About::organ, "", tr("There is no organ. Add one (Add), or import one (File > Import)."), "", {}});
    return out;
  }
  const std::vector<Checked> bodies = checked_bodies(document, *description);
  for (const Checked& body : bodies) check_attachment(body, out);
  for (const Checked& body : bodies) check_size(document, body, out);
  if (std::none_of(out.begin(), out.end(), [](const Finding& f) { return f.about == About::size; }))
    check_view(*description, bodies, out);
  return out;
}

}  // namespace trocar::modeller
