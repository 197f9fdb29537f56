#include <algorithm>
#include <chrono>

#include <trocar/modeller/drive/body_memory.hpp>
#include <trocar/modeller/drive/built.hpp>
#include <trocar/scene/checks/standing.hpp>

namespace trocar::modeller {
namespace {

/// A ball about the middle of the sections that holds a quarter of the body.
scene::Anchor middle_of(const std::vector<scene::Section>& sections, double cell) {
  const scene::Section& middle = sections[sections.size() / 2];
  scene::Anchor anchor;
  anchor.centre = middle.centre;
  anchor.radius = 0.6 * std::max(length(middle.across), length(middle.deep)) + 1.5 * cell;
  return anchor;
}

/// A ball in the middle of a box, as large as its smaller sides allow.
scene::Anchor middle_of(const geometry::Bounds& box, double cell) {
  const Vec3d size = box.high - box.low;
  scene::Anchor anchor;
  anchor.centre = (box.low + box.high) / 2.0;
  anchor.radius = 0.35 * std::min({size.x, size.y, size.z}) + 1.5 * cell;
  return anchor;
}

void hold_what_nothing_holds(scene::Description& d, std::vector<std::string>& notes) {
  const auto note = [&](const std::string& name) {
    notes.push_back("nothing holds " + name + " yet: it is shown as if its middle were held");
  };
  for (scene::Solid& solid : d.solids)
    if (solid.anchors.empty()) {
      if (!solid.sections.empty())
        solid.anchors.push_back(middle_of(solid.sections, solid.cell));
      else if (solid.shape.any())
        solid.anchors.push_back(middle_of(scene::size_of(solid.shape).box, solid.cell));
      else if (solid.tets)
        solid.anchors.push_back(middle_of(geometry::bounds(solid.tets->mesh.points), solid.cell));
      note(solid.name);
    }
  for (scene::Pouch& pouch : d.pouches)
    if (pouch.held.empty() && !pouch.free) {
      pouch.held.push_back(pouch.sections.empty() ? middle_of(scene::size_of(pouch.shape).box, pouch.spacing)
                                                  : middle_of(pouch.sections, pouch.spacing));
      note(pouch.name);
    }
}

}  // namespace

Built build(const Document& document) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  Built out;
  out.version = document.version();
  try {
    std::optional<scene::Description> read = document.description(out.faults);
    if (read && out.faults.empty()) {
      hold_what_nothing_holds(*read, out.notes);
      out.model = std::make_unique<sim::Model>(scene::compile(*read, &out.report));
    }
  } catch (const core::BadInput& bad) {
    out.faults = bad.faults();
  }
  out.seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  return out;
}

double predicted_us(const scene::BodyReport& b) {
  if (b.kind == "strand") return 0.16 * b.springs;
  const double ns = b.kind == "solid"                           ? 1.7
                    : b.kind == "cuttable"                      ? 2.9
                    : b.kind == "membrane" || b.kind == "pouch" ? 3.5
                                                                : 0;
  return 1e-3 * ns * b.springs * std::max(1, b.substeps);
}

std::vector<ReadOut> read_outs(const Built& built, std::uint64_t standing_ticks) {
  std::vector<ReadOut> out;
  if (!built.good()) return out;
  scene::Standing standing;
  if (standing_ticks > 0) standing = scene::stand(*built.model, standing_ticks, [] { return true; });
  const std::vector<std::size_t> bytes = memory_of_bodies(*built.model, built.report);
  for (const scene::BodyReport& b : built.report.bodies) {
    ReadOut r{b.name, b.kind, b.nodes, b.springs, b.substeps, b.volume * 1e6, b.mass * 1e3, b.dt_limit * 1e3};
    r.predicted_us = predicted_us(b);
    r.bytes = bytes[out.size()];
    for (const scene::Standing::Organ& o : standing.organs)
      if (o.name == b.name) r.off_mm = o.off * 1e3;
    out.push_back(r);
  }
  return out;
}

}  // namespace trocar::modeller
