#include <stdexcept>

#include <trocar/scene/compile/compile_motion.hpp>
#include <trocar/sim/model/bodies.hpp>

namespace trocar::scene {
namespace {

/// Number of a solid in the Model, -1 where it is not there or can be cut.
int lattice_of(const sim::Model& model, const std::string& solid) {
  return sim::lattice_of(model, model.organ_index(solid));
}

std::vector<Vec3d> centreline_of(const Description& d, const WaveSetting& wave) {
  if (!wave.centreline.empty()) return wave.centreline;
  std::vector<Vec3d> line;
  for (const Solid& s : d.solids) {
    if (s.name != wave.solid) continue;
    for (const Section& section : s.sections) line.push_back(section.centre);
    if (s.shape.tube) line = s.shape.tube->line;
  }
  return line;
}

double density_of(const Description& d, const WaveSetting& wave) {
  for (const Solid& s : d.solids)
    for (const Tissue& t : d.tissues)
      if (s.name == wave.solid && t.name == s.tissue) return t.density;
  return 1000;
}

void compile_wave(const Description& d, const WaveSetting& wave, sim::Model& model, std::vector<core::Fault>& faults) {
  tissue::ForceWaveDescription f;
  f.centreline = centreline_of(d, wave);
  for (const WaveSetting::Station& s : wave.stations) f.stations.push_back({s.s, s.pressure, s.speed});
  f.width = wave.width;
  f.period = 60 / wave.per_minute;
  f.first = wave.first;
  f.cycle = wave.cycle;
  f.active = wave.active_share;
  sim::PeristalsisModel out;
  out.solid = lattice_of(model, wave.solid);
  if (out.solid < 0) return;
  try {
    const tissue::NetworkModel& network = model.solids[size_t(out.solid)].network;
    std::vector<double> volume;
    for (const double mass : network.mass) volume.push_back(mass / density_of(d, wave));
    out.wave = tissue::build(f, network.rest, volume);
  } catch (const std::invalid_argument& e) {
    faults.push_back({wave.at, "expected waves along '" + wave.solid + "', got: " + e.what()});
    return;
  }
  model.motion.peristalsis.push_back(std::move(out));
}

std::vector<std::int32_t> rigidly_held(const tissue::NetworkModel& network) {
  std::vector<std::int32_t> held;
  for (std::int32_t i = 0; i < network.nodes; ++i)
    if (network.fixed[size_t(i)] == tissue::kHeld) held.push_back(i);
  return held;
}

void compile_breathing(const BreathingSetting& b, sim::Model& model) {
  sim::BreathingModel& out = model.motion.breathing;
  out.period = 60 / b.per_minute;
  out.way = b.amplitude * normalised(b.direction, {0, -1, 0});
  out.organs.assign(size_t(model.organs()), 0.0);
  out.strands.assign(model.strands.size(), 0.0);
  out.membranes.assign(model.membranes.size(), 0.0);
  const auto set = [](std::vector<double>& shares, int body, double share) {
    if (body >= 0) shares[size_t(body)] = share;
  };
  for (const BreathingSetting::Carried& c : b.carries) {
    set(out.organs, model.organ_index(c.body), c.share);
    set(out.strands, model.strand_index(c.body), c.share);
    set(out.membranes, model.membrane_index(c.body), c.share);
  }
  for (const sim::SolidModel& s : model.solids) out.held.push_back(rigidly_held(s.network));
}

}  // namespace

void compile_motion(const Description& d, sim::Model& model, std::vector<core::Fault>& faults) {
  for (const WaveSetting& wave : d.peristalsis) compile_wave(d, wave, model, faults);
  if (d.breathing) compile_breathing(*d.breathing, model);
}

}  // namespace trocar::scene
