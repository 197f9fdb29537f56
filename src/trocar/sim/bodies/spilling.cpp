#include <algorithm>
#include <cmath>

#include <trocar/interactions/bodies/strand_body.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/sim/bodies/sling.hpp>
#include <trocar/sim/bodies/spilling.hpp>
#include <trocar/vessels/lumen.hpp>

namespace trocar::sim {
namespace {

using interactions::Rigid;

constexpr double kClosing = double(vessels::LumenGraph{}.closing_cover);
constexpr double kFallsAt = 0.02;  // [m/s] a stone that leaves a hole.  Our choice

/// The parted element that is nearest to the pouch; -1: it leads on.
int parted_next_to(const std::vector<std::uint8_t>& alive, bool at_start) noexcept {
  const int elements = int(alive.size());
  for (int k = 0; k < elements; ++k) {
    const int e = at_start ? k : elements - 1 - k;
    if (!alive[size_t(e)]) return e;
  }
  return -1;
}

/// Where along it the element was parted: where the blades were, else its middle [m].
double parted_at(const StepContext& c, int strand, int element) noexcept {
  const interactions::StrandBody& body = rod_of(c.model, StrandRef{size_t(strand)});
  for (int i = 0; i < c.state.cut_count; ++i) {
    const interactions::Cut& cut = c.state.cuts[size_t(i)];
    if (cut.strand == strand && interactions::place_at(body, cut.s).element == element) return cut.s;
  }
  return 0.5 * (body.arc[size_t(element)] + body.arc[size_t(element) + 1]);
}

/// Share of the lumen that clips between the pouch and `s` leave.
double open_share(const StepContext& c, int strand, bool at_start, double s) noexcept {
  double share = 1;
  for (int i = 0; i < c.state.clip_count; ++i) {
    const interactions::Clip& clip = c.state.clips[size_t(i)];
    if (clip.strand != strand || (at_start ? clip.s > s : clip.s < s)) continue;
    share = clip.cover >= kClosing ? 0 : std::min(share, 1 - clip.cover);
    if (share <= 0) return 0;
  }
  visit_loops(c.model, c.state, [&](const LoopClosure& loop) {
    if (loop.at.body != BodyId::strand(size_t(strand)) || (at_start ? loop.s > s : loop.s < s)) return;
    share = loop.cover >= kClosing ? 0 : std::min(share, 1 - loop.cover);
  });
  return share;
}

// --- stones ---

double volume_of(const interactions::RigidModel& m) noexcept {
  return 4.0 / 3.0 * portable::pi * m.pebble.x * m.pebble.y * m.pebble.z;
}

/// A pebble goes with its length ahead: what has to pass is as wide as its width.
bool passes(const interactions::RigidModel& m, double area) noexcept {
  return portable::pi * m.pebble.y * m.pebble.y <= area;
}

bool is_free(const interactions::RigidModels& models, const Rigid::States& states, Vec3d place, double reach) noexcept {
  for (size_t i = 0; i < states.size(); ++i)
    if (!states[i].inside() && length(states[i].x - place) < reach + models.list[i].reach) return false;
  return true;
}

/// Its length along the way out, outside of the wall.
void fall_out(const tissue::Leak& hole, Vec3d place, interactions::RigidState& s) noexcept {
  s.x = place;
  s.q = quat_from_two_vectors(Vec3d{1, 0, 0}, hole.direction);
  s.v = kFallsAt * hole.direction;
  s.w = {};
  s.still = 0;
}

}  // namespace

tissue::Leak leak_by_duct(const StepContext& c, MembraneRef r) noexcept {
  const MembraneBody& m = model_of(c.model, r);
  if (m.duct < 0) return {};
  const StrandRef duct{size_t(m.duct)};
  const interactions::StrandBody& body = rod_of(c.model, duct);
  const tissue::StrandState& tube = state_of(c.state, duct);
  const int element = parted_next_to(tube.alive, m.duct_at_start);
  if (element < 0 || body.model.lumen.empty()) return {};
  const double open = open_share(c, m.duct, m.duct_at_start, parted_at(c, m.duct, element));
  const double radius = body.model.lumen[size_t(element)];
  const int end = m.duct_at_start ? element : element + 1, before = m.duct_at_start ? end - 1 : end + 1;
  const Vec3d place = tube.x[size_t(end)];
  const bool stump = before >= 0 && before < body.nodes();
  const Vec3d direction = normalised(stump ? place - tube.x[size_t(before)] : Vec3d{}, {0, 0, 1});
  return tissue::leak_through(m.sheet, open * portable::pi * radius * radius, place, direction,
                              c.work.membranes[r.index].body, c.state.membranes[r.index]);
}

void update_spilled_stones(StepContext& c) noexcept {
  const interactions::RigidModels& models = interactions::part_of<Rigid>(c.model);
  Rigid::States& states = interactions::part_of<Rigid>(c.state);
  for (size_t i = 0; i < states.size(); ++i) {
    if (!states[i].inside()) continue;
    const interactions::RigidModel& stone = models.list[i];
    const size_t pouch = size_t(stone.inside);
    const MembraneBody& m = c.model.membranes[pouch];
    const tissue::MembraneWork& work = c.work.membranes[pouch].body;
    const tissue::Leak& hole = c.work.membranes[pouch].by_wall;
    states[i].x = tissue::enclosed_volume(m.sheet.triangles, work.place, {}).centre;
    const bool carried = hole.picolitres > 0 || dot(hole.direction, c.model.gravity) > 0;
    if (!(hole.area > 0) || !carried || !passes(stone, hole.area)) continue;
    const Vec3d place = hole.place + (stone.reach + m.sheet.thickness) * hole.direction;
    if (!is_free(models, states, place, stone.reach)) continue;
    fall_out(hole, place, states[i]);
    tissue::take_out(m.sheet, volume_of(stone), c.state.membranes[pouch]);
  }
}

}  // namespace trocar::sim
