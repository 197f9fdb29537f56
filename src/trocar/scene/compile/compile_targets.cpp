#include <algorithm>
#include <cmath>

#include <trocar/scene/compile/compile_targets.hpp>

namespace trocar::scene {
namespace {

void add_target(sim::Model& model, sim::VisibilityTarget target, const std::vector<sim::VisibilitySample>& samples) {
  target.first = std::int32_t(model.samples.size());
  target.count = std::int32_t(samples.size());
  for (sim::VisibilitySample s : samples) {
    s.target = std::int32_t(model.targets.size());
    model.samples.push_back(s);
  }
  model.targets.push_back(target);
}

/// Both jaw tips, and the shaft between trocar and jaws.
void add_hand(sim::Model& model, std::int32_t hand) {
  const std::string& name = model.hands[size_t(hand)].name;
  for (std::int32_t jaw = 0; jaw < 2; ++jaw)
    add_target(model, {sim::VisibilityTarget::jaw, name + (jaw == 0 ? ".jaw_a" : ".jaw_b"), hand, 0, 0}, {{0, jaw, 0}});
  std::vector<sim::VisibilitySample> track;
  for (double share : {0.4, 0.6, 0.8, 0.95}) track.push_back({0, 0, share});
  add_target(model, {sim::VisibilityTarget::shaft, name + ".shaft", hand, 0, 0}, track);
}

/// One sample an element, from start to end: for following a tube, and for the stumps where it was cut.
void add_trace(sim::Model& model, std::int32_t strand) {
  std::vector<sim::VisibilitySample> samples;
  for (std::int32_t e = 0; e + 1 < model.strand_bodies[size_t(strand)].nodes(); ++e) samples.push_back({0, e, 0.5});
  add_target(model, {sim::VisibilityTarget::strand, model.strands[size_t(strand)].name + ".trace", strand, 0, 0},
             samples);
}

/// Sixteen vertices of its surface.
std::vector<sim::VisibilitySample> all_around(const tissue::Skin& skin) {
  constexpr size_t kSamples = 16;
  std::vector<std::int32_t> outside;
  for (int v = 0; v < skin.size(); ++v)
    if (skin.at_surface(v)) outside.push_back(v);
  std::vector<sim::VisibilitySample> samples;
  for (size_t k = 0; k < kSamples; ++k)
    samples.push_back({0, outside[(2 * k + 1) * outside.size() / (2 * kSamples)], 0});
  return samples;
}

/// The vertex at an organ's surface that was drawn nearest to a point inside it.
std::int32_t surface_over(const tissue::Skin& skin, Vec3d inside) {
  std::int32_t nearest = -1;
  double least = 0;
  for (std::int32_t v = 0; v < skin.size(); ++v) {
    if (!skin.at_surface(v)) continue;
    const double off = length(vec_cast<double>(skin.rest[size_t(v)]) - inside);
    if (nearest < 0 || off < least) nearest = v, least = off;
  }
  return nearest;
}

/// The corner of a membrane's triangle that is next to the place on it.
std::int32_t nearest_corner(const interactions::MaterialPoint& p) {
  return p.node[size_t(std::max_element(p.weight.begin(), p.weight.begin() + p.count) - p.weight.begin())];
}

/// Where a vessel opens by itself: the place of its host that is next to it. Nothing can be reported where it has none.
void add_bleeder(sim::Model& model) {
  const sim::Bleeder& b = model.vessels.bleeder;
  if (b.vessel < 0) return;
  const std::vector<interactions::VesselPoint>& points = model.vessels.list[size_t(b.vessel)].path.points;
  const auto nearest = std::min_element(points.begin(), points.end(), [&b](const auto& p, const auto& q) {
    return std::fabs(p.s - b.s) < std::fabs(q.s - b.s);
  });
  const interactions::MaterialPoint& on = nearest->rides;
  const std::int32_t i = std::int32_t(on.body.index());
  if (on.body.is(BodyKind::strand))
    add_target(model, {sim::VisibilityTarget::strand, "bleeder", i, 0, 0}, {{0, on.element, double(on.weight[0])}});
  if (on.body.is(BodyKind::organ))
    add_target(model, {sim::VisibilityTarget::organ, "bleeder", i, 0, 0},
               {{0, surface_over(model.skin(i), nearest->drawn), 0}});
  if (on.body.is(BodyKind::membrane))
    add_target(model, {sim::VisibilityTarget::fold, "bleeder", i, 0, 0}, {{0, nearest_corner(on), 0}});
}

void add_mark(sim::Model& model, std::int32_t mark) {
  const sim::MarkModel& m = model.marks[size_t(mark)];
  std::vector<sim::VisibilitySample> samples;
  for (std::int32_t k = 0; k < (m.is_stripe() ? sim::kStripeSamples : sim::kDiscSamples); ++k)
    samples.push_back({0, k, 0});
  add_target(model, {sim::VisibilityTarget::mark, m.name, mark, 0, 0}, samples);
}

}  // namespace

void compile_targets(sim::Model& model) {
  for (size_t t = 0; t < model.hands.size(); ++t) add_hand(model, std::int32_t(t));
  for (size_t i = 0; i < model.strands.size(); ++i)
    for (const sim::LandmarkModel& l : model.strands[i].landmarks) {
      std::vector<sim::VisibilitySample> samples;
      constexpr int kSamples = 5;
      for (int k = 0; k < kSamples; ++k) {
        const interactions::StrandPlace p =
            interactions::place_at(model.strand_bodies[i], l.from + (l.to - l.from) * (k + 0.5) / kSamples);
        samples.push_back({0, p.element, p.w});
      }
      add_target(model, {sim::VisibilityTarget::strand, model.strands[i].name + "." + l.name, std::int32_t(i), 0, 0},
                 samples);
    }
  for (size_t i = 0; i < model.strands.size(); ++i)
    if (!model.strands[i].landmarks.empty()) add_trace(model, std::int32_t(i));
  for (int i = 0; i < model.organs(); ++i)
    add_target(model, {sim::VisibilityTarget::organ, model.organ_name(i), i, 0, 0}, all_around(model.skin(i)));
  for (size_t i = 0; i < model.membranes.size(); ++i)
    if (const sim::MembraneBody& m = model.membranes[i]; m.sheet.closed())
      add_target(model, {sim::VisibilityTarget::fold, m.name, std::int32_t(i), 0, 0}, all_around(m.skin));
  add_bleeder(model);
  for (size_t i = 0; i < model.marks.size(); ++i) add_mark(model, std::int32_t(i));
}

}  // namespace trocar::scene
