// Where the hands' instruments are: small questions that exercises ask all the time.
#pragma once

#include <trocar/sim/model/state.hpp>

namespace trocar::training {

inline double norm(const double (&v)[3]) { return length(Vec3d{v[0], v[1], v[2]}); }

inline size_t hands(const sim::Model& model) { return model.hands.size(); }

inline Vec3d tip_of(const sim::Model& model, const sim::State& state, size_t hand) {
  return sim::tip_frame_of(model, state, hand).tip;
}

/// Where a strand's, an organ's or a fold's sample is.
inline Vec3d place_of(const sim::Model& model, const sim::State& state, const sim::VisibilitySample& sample) {
  const sim::VisibilityTarget& t = model.targets[size_t(sample.target)];
  const size_t i = size_t(t.index);
  if (t.kind == sim::VisibilityTarget::strand)
    return interactions::point_at(model.strand_bodies[i], state.strands[i], {sample.where, sample.w});
  if (t.kind == sim::VisibilityTarget::fold)
    return tissue::skin_point(view_of(model.membranes[i].sheet.network, state.membranes[i].network),
                              model.membranes[i].skin, sample.where);
  return tissue::skin_point(nodes_of(model, state, t.index), model.skin(t.index), sample.where);
}

/// Arc length of the first held point of strand `strand` in this hand's jaws; -1 if they hold none of it.
inline double held_arc(const sim::Model& model, const sim::State& state, size_t hand, int strand) {
  const interactions::ToolState& tool = state.tools[hand];
  if (tool.holds == 0 || tool.hold[0].at.body != BodyId::maybe(BodyKind::strand, strand)) return -1;
  return interactions::arc_at(model.strand_bodies[size_t(strand)], place_on_rod(tool.hold[0].at));
}

/// Chord over length of strand `strand` up to arc length `to`, or up to a cut before it.
inline double straightness_of(const sim::Model& model, const sim::State& state, int strand, double to) {
  const interactions::StrandBody& body = model.strand_bodies[size_t(strand)];
  const tissue::StrandState& s = state.strands[size_t(strand)];
  double way = 0;
  size_t last = 0;
  for (size_t e = 0; int(e) + 1 < body.nodes() && body.arc[e + 1] <= to + 1e-9 && s.alive[e]; ++e) {
    way += length(s.x[e + 1] - s.x[e]);
    last = e + 1;
  }
  return way > 0 ? length(s.x[last] - s.x[0]) / way : 0;
}

/// Are both ends that a cut of a strand made in view? The two elements on either side of element `cut` stand for them.
inline bool stumps_in_view(const sim::Model& model, const sim::State& state, int trace_target, int cut) {
  constexpr int kStump = 2;
  if (cut < 0 || trace_target < 0) return false;
  const sim::VisibilityTarget& t = model.targets[size_t(trace_target)];
  int samples[2] = {0, 0}, seen[2] = {0, 0};
  for (int i = t.first; i < t.first + t.count; ++i) {
    const int off = model.samples[size_t(i)].where - cut;
    if (off == 0 || off > kStump || off < -kStump) continue;
    ++samples[off > 0];
    seen[off > 0] += state.seen[size_t(i)];
  }
  return samples[0] > 0 && samples[1] > 0 && 2 * seen[0] >= samples[0] && 2 * seen[1] >= samples[1];
}

}  // namespace trocar::training
