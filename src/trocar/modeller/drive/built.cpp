#include <algorithm>
#include <chrono>

#include <trocar/core/text.hpp>
#include <trocar/modeller/drive/body_memory.hpp>
#include <trocar/modeller/drive/built.hpp>
#include <trocar/scene/checks/equilibrium_check.hpp>
#include <trocar/scene/checks/predicted_cost.hpp>

namespace trocar::modeller {
namespace {

void hold_what_nothing_holds(scene::Description& d, std::vector<std::string>& notes) {
  const auto note = [&](const std::string& name) {
    notes.push_back(tr("{} is not attached. Attach it (K) before you operate.", name));
  };
  for (scene::Solid& solid : d.solids)
    if (!is_attached(solid)) {
      if (!solid.sections.empty() || solid.shape.any() || solid.tets) solid.anchors.push_back(middle_hold(solid));
      note(solid.name);
    }
  for (scene::Pouch& pouch : d.pouches)
    if (!is_attached(pouch)) {
      pouch.held.push_back(middle_hold(pouch));
      note(pouch.name);
    }
}

}  // namespace

Built build(const Document& document) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  Built out;
  out.version = document.version();
  std::optional<scene::Description> read;
  try {
    read = document.description(out.faults);
    out.findings = readiness(document, read ? &*read : nullptr, out.faults);
    if (read && out.faults.empty()) {
      hold_what_nothing_holds(*read, out.notes);
      out.model = std::make_unique<sim::Model>(scene::compile(*read, &out.report));
    }
  } catch (const core::BadInput& bad) {
    out.faults = bad.faults();
    if (out.findings.empty()) out.findings = readiness(document, read ? &*read : nullptr, out.faults);
  }
  out.seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  return out;
}

std::vector<ReadOut> read_outs(const Built& built, std::uint64_t standing_ticks) {
  std::vector<ReadOut> out;
  if (!built.good()) return out;
  scene::EquilibriumCheck equilibrium;
  if (standing_ticks > 0) equilibrium = scene::check_equilibrium(*built.model, standing_ticks);
  const std::vector<std::size_t> bytes = memory_of_bodies(*built.model, built.report);
  for (const scene::BodyReport& b : built.report.bodies) {
    ReadOut r{b.name, b.kind, b.nodes, b.springs, b.substeps, b.volume * 1e6, b.mass * 1e3, b.dt_limit * 1e3};
    r.predicted_us = scene::predicted_us(b);
    r.bytes = bytes[out.size()];
    for (const scene::EquilibriumCheck::Organ& o : equilibrium.organs)
      if (o.name == b.name) r.off_mm = o.off * 1e3;
    out.push_back(r);
  }
  return out;
}

}  // namespace trocar::modeller
