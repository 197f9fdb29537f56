#include <algorithm>
#include <queue>
#include <string>
#include <tuple>

#include <trocar/sim/model/bodies.hpp>
#include <trocar/training/observe/stations.hpp>

namespace trocar::training {
namespace {

constexpr float kBeside = 0.006f;  // [m] from a disc: vertices that begin at it. Our choice

/// The mark behind a target, if that is a disc on an organ.
const sim::MarkModel* disc_on_organ(const sim::Model& model, std::int32_t target) {
  const sim::VisibilityTarget& t = model.targets[size_t(target)];
  if (t.kind != sim::VisibilityTarget::mark) return nullptr;
  const sim::MarkModel& mark = model.marks[size_t(t.index)];
  return mark.on_organ() ? &mark : nullptr;
}

/// From all sources at once along the edges of a skin in the drawn shape: which source is nearest to each vertex.
std::vector<std::int16_t> nearest_source(const tissue::Skin& skin, std::span<const sim::MarkModel* const> sources) {
  using Reached = std::tuple<float, std::int32_t, std::int16_t>;  // way [m], vertex, source
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> front;
  for (size_t i = 0; i < sources.size(); ++i)
    for (std::int32_t v = 0; v < skin.size(); ++v)
      if (const float way = length(skin.rest[size_t(v)] - vec_cast<float>(sources[i]->place)); way < kBeside)
        front.push({way, v, std::int16_t(i)});
  std::vector<std::int16_t> nearest(size_t(skin.size()), std::int16_t(-1));
  while (!front.empty()) {
    const auto [way, vertex, source] = front.top();
    front.pop();
    if (nearest[size_t(vertex)] >= 0) continue;
    nearest[size_t(vertex)] = source;
    for (int k = skin.face_first[size_t(vertex)]; k < skin.face_first[size_t(vertex) + 1]; ++k)
      for (const int next : skin.triangles[size_t(skin.face[size_t(k)])])
        if (nearest[size_t(next)] < 0)
          front.push({way + length(skin.rest[size_t(next)] - skin.rest[size_t(vertex)]), next, source});
  }
  return nearest;
}

}  // namespace

Stations::Stations(const sim::Model& model, std::span<const std::int32_t> marks, double spacing)
    : m_count(int(marks.size())), m_spacing(spacing) {
  std::vector<const sim::MarkModel*> discs;
  for (const std::int32_t target : marks)
    if (const sim::MarkModel* disc = disc_on_organ(model, target)) discs.push_back(disc);
  if (discs.empty()) return;
  m_body = discs.front()->at.body;
  m_station = nearest_source(model.skin(discs.front()->body()), discs);
}

double Stations::of_held(const interactions::Bodies& bodies, const interactions::Hold& hold) const {
  std::int32_t vertex = vertex_of(bodies, hold.at);
  while (size_t(vertex) >= m_station.size()) vertex = tets_of(bodies, m_body).source[size_t(vertex)];  // made by a cut
  return of_vertex(size_t(vertex));
}

double Stations::held_at(const sim::Model& model, const sim::State& state, size_t hand) const {
  const interactions::ToolState& tool = state.tools[hand];
  if (tool.holds == 0 || tool.hold[0].at.body != m_body) return -1;
  double sum = 0;
  for (int i = 0; i < tool.holds; ++i) sum += of_held(bodies_of(model, state), tool.hold[i]);
  return sum / tool.holds;
}

std::optional<Stations::Span> Stations::held_span(const sim::Model& model, const sim::State& state, size_t hand) const {
  const interactions::ToolState& tool = state.tools[hand];
  if (tool.holds == 0 || tool.hold[0].at.body != m_body) return {};
  Span span{1e9, -1e9};
  for (int i = 0; i < tool.holds; ++i) {
    const double s = of_held(bodies_of(model, state), tool.hold[i]);
    span = {std::min(span.from, s), std::max(span.to, s)};
  }
  return span;
}

std::string no_stations(const sim::Model& model, std::span<const std::int32_t> marks) {
  const sim::MarkModel* first = marks.empty() ? nullptr : disc_on_organ(model, marks.front());
  for (const std::int32_t target : marks) {
    const sim::MarkModel* disc = disc_on_organ(model, target);
    if (!disc || !first || disc->at.body != first->at.body) return "expected discs on one organ, got others";
  }
  return first ? "" : "expected discs on one organ, got none";
}

}  // namespace trocar::training
