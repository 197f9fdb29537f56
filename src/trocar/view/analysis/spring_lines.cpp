#include <algorithm>

#include <trocar/view/analysis/spring_lines.hpp>

namespace trocar::view {
namespace {

/// Lines one after the other, from the start in each picture.
class Lines {
 public:
  Lines(const AnalysisOptions& options, FalseColourMesh& to)
      : m_options(options), m_to(to), m_before(to.buffer.size()) {
    m_to.buffer.positions.clear(), m_to.buffer.paint.clear(), m_to.buffer.indices.clear(), m_to.value.clear();
  }
  void add(Vec3d a, Vec3d b, double strain) {
    const render::Paint paint = paint_shown_as(colour_of_strain(m_options, strain));
    for (const Vec3d end : {a, b}) {
      m_to.buffer.indices.push_back(m_to.buffer.add(vec_cast<float>(end), paint));
      m_to.value.push_back(float(strain));
    }
  }
  void show(render::Backend& backend) { m_to.show(backend, m_to.buffer.size() != m_before, render::Primitive::lines); }

 private:
  const AnalysisOptions& m_options;
  FalseColourMesh& m_to;
  std::uint32_t m_before;
};

void add_network(const tissue::NetworkModel& model, const tissue::NetworkState& state, Lines& to) {
  for (int s = 0; s < model.springs; ++s) {
    if (spring_scale(model, state, s) <= 0) continue;
    const int a = model.spring_nodes[2 * std::size_t(s)], b = model.spring_nodes[2 * std::size_t(s) + 1];
    to.add(position(model, state, a), position(model, state, b), spring_strain(model, state, s));
  }
}

std::vector<std::array<std::int32_t, 2>> edges_of(const geometry::CuttableTets& tets) {
  std::vector<std::array<std::int32_t, 2>> edges;
  for (const geometry::Tet& cell : tets.cells)
    for (const auto& [i, j] : tissue::kCellEdges) {
      const std::int32_t a = cell[std::size_t(i)], b = cell[std::size_t(j)];
      edges.push_back({std::min(a, b), std::max(a, b)});
    }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

void add_strand(const tissue::StrandModel& model, const tissue::StrandState& state, Lines& to) {
  for (std::size_t e = 0; e + 1 < state.x.size(); ++e)
    if (state.alive[e]) to.add(state.x[e], state.x[e + 1], element_strain(model, state, int(e)));
}

}  // namespace

SpringLines::SpringLines(const sim::Model& model)
    : m_model(&model),
      m_organs(std::size_t(model.organs())),
      m_strands(model.strands.size()),
      m_membranes(model.membranes.size()),
      m_edges(model.cuttables.size()),
      m_edges_of(model.cuttables.size(), ~std::uint64_t(0)) {}

void SpringLines::update(const sim::State& state, const AnalysisOptions& o, render::Backend& backend) {
  const auto show = [&](auto r, FalseColourMesh& of) {
    Lines lines(o, of);
    add_network(network_of(*m_model, r), network_state_of(state, r), lines);
    lines.show(backend);
  };
  sim::visit_solids(*m_model, [&](auto r) { show(r, m_organs[r.organ()]); });
  sim::visit_cuttables(*m_model, [&](auto r) {
    const tissue::CuttableState& now = state_of(state, r);
    if (m_edges_of[r.index] != now.version) m_edges[r.index] = edges_of(now.tets), m_edges_of[r.index] = now.version;
    Lines lines(o, m_organs[r.organ()]);
    const tissue::NodeView nodes = view_of(model_of(*m_model, r).body, now);
    for (const auto& [a, b] : m_edges[r.index]) {
      const double drawn = length(now.tets.rest[std::size_t(b)] - now.tets.rest[std::size_t(a)]);
      const Vec3d from = nodes.position(a), to = nodes.position(b);
      lines.add(from, to, drawn > 0 ? length(to - from) / drawn - 1 : 0);
    }
    lines.show(backend);
  });
  sim::visit_strands(*m_model, [&](auto r) {
    Lines lines(o, m_strands[r.index]);
    add_strand(rod_of(*m_model, r).model, state_of(state, r), lines);
    lines.show(backend);
  });
  sim::visit_membranes(*m_model, [&](auto r) { show(r, m_membranes[r.index]); });
}

}  // namespace trocar::view
