#include <trocar/training/observe/lumen_check.hpp>

namespace trocar::training {

LumenCheck::LumenCheck(const sim::Model& model, int strand, double closing_cover)
    : m_strand(strand), m_nodes(model.strand_bodies[size_t(strand)].nodes()), m_cover(float(closing_cover)) {
  // A chain of segments between the strand's nodes; segment e is the element e.
  for (std::int32_t e = 0; e + 1 < m_nodes; ++e) m_segments.push_back({e, e + 1});
  m_cuts.resize(m_segments.size());
  vessels::LumenGraph graph;
  graph.nodes = m_nodes;
  graph.segments = m_segments;
  m_scratch.resize(vessels::lumen_scratch_size(graph));
}

bool LumenCheck::leads(int from, int to, std::int32_t cuts) {
  vessels::LumenGraph graph;
  graph.nodes = m_nodes;
  graph.segments = m_segments;
  graph.closures = {m_closures.data(), size_t(m_closure_count)};
  graph.cuts = {m_cuts.data(), size_t(cuts)};
  graph.closing_cover = m_cover;
  return vessels::open_path(graph, from, to, m_scratch);
}

/// The element that a clip or a loop at `s` closes; -1: none. One within an element that is cut closes the next one on
/// its own side of the cut.
int LumenCheck::closed_at(const sim::Model& model, const sim::State& state, double s) const {
  const interactions::StrandBody& body = model.strand_bodies[size_t(m_strand)];
  const int element = interactions::place_at(body, s).element;
  if (state.strands[size_t(m_strand)].alive[size_t(element)]) return element;
  for (int i = 0; i < state.cut_count; ++i) {
    const interactions::Cut& cut = state.cuts[size_t(i)];
    if (cut.strand != m_strand || interactions::place_at(body, cut.s).element != element) continue;
    const int beside = s < cut.s ? element - 1 : element + 1;
    return beside + 1 < m_nodes ? beside : -1;
  }
  return element;
}

void LumenCheck::update(const sim::Model& model, const sim::State& state) {
  m_closure_count = 0;
  for (int i = 0; i < state.clip_count; ++i) {
    const interactions::Clip& clip = state.clips[size_t(i)];
    if (clip.strand != m_strand) continue;
    const int element = closed_at(model, state, clip.s);
    if (element >= 0) m_closures[size_t(m_closure_count++)] = {element, float(clip.cover)};
  }
  sim::visit_loops(model, state, [&](const sim::LoopClosure& loop) {
    if (loop.at.body != BodyId::strand(size_t(m_strand)) || size_t(m_closure_count) >= m_closures.size()) return;
    const int element = closed_at(model, state, loop.s);
    if (element >= 0) m_closures[size_t(m_closure_count++)] = {element, float(loop.cover)};
  });
  std::int32_t cuts = 0;
  const std::vector<std::uint8_t>& alive = state.strands[size_t(m_strand)].alive;
  for (std::int32_t e = 0; e + 1 < m_nodes; ++e)
    if (!alive[size_t(e)]) m_cuts[size_t(cuts++)] = e;
  if (m_cut < 0 && cuts > 0) m_cut = m_cuts[0];
  m_occluded = !leads(0, m_nodes - 1, cuts);
  m_closed = cuts > 0 && !leads(0, m_cuts[0], cuts) && !leads(m_cuts[size_t(cuts) - 1] + 1, m_nodes - 1, cuts);
}

}  // namespace trocar::training
