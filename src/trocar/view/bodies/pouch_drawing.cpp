#include <algorithm>
#include <map>

#include <trocar/render/meshes/mesh_arrays.hpp>
#include <trocar/view/bodies/pouch_drawing.hpp>

namespace trocar::view {
namespace {

constexpr std::uint32_t kParts = 3;     // of an edge
constexpr double kFatReach = 0.013;     // [m] from where it is held
constexpr double kFatHeight = 0.0012;   // [m]
constexpr double kFatLobule = 0.006;    // [m]
constexpr std::uint8_t kTornEdge = 90;  // blood on what is left beside a tear
constexpr float kRounded = 0.75f;       // [Boubekeur & Alexa 2008]

}  // namespace

PouchDrawing::PouchDrawing(const sim::Model& model, int membrane, render::Backend& backend, const Detail& detail)
    : m_membrane(&model.membranes[std::size_t(membrane)]),
      m_look(&look(model, m_membrane->look)),
      m_index(membrane),
      m_torn(m_membrane->sheet.triangles.size(), 0),
      m_marks(model, BodyId::membrane(std::size_t(membrane))),
      m_peeled(model, membrane, {}) {
  for (const auto& t : m_membrane->sheet.triangles)
    for (int node : t) m_whole.push_back(std::uint32_t(node));
  divide();
  m_height.assign(m_places.size(), 0.0f);
  m_peeled = Peeled(model, membrane, flat_places());
  place(tissue::rest_state(m_membrane->sheet));
  connect(m_torn);
  m_buffer.rest = m_buffer.positions;
  paint();
  place(tissue::rest_state(m_membrane->sheet));
  m_marks = HeatMarks(model, BodyId::membrane(std::size_t(membrane)), flat_places());
  coarsen(m_buffer, detail, kBends);
  m_mesh = OwnedMesh(backend, m_buffer.data());
}

/// The drawn vertices on the wall's flat triangles, at rest.
std::vector<Vec3d> PouchDrawing::flat_places() const {
  std::vector<Vec3d> flat(m_places.size());
  for (std::size_t i = 0; i < m_places.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k)
      flat[i] += double(m_places[i].share[k]) * m_membrane->sheet.network.rest[m_places[i].node[k]];
  return flat;
}

/// The small triangles; neighbours share the vertices on their common edge.
void PouchDrawing::divide() {
  std::map<std::array<std::uint32_t, 6>, std::uint32_t> known;  // nodes and parts, by rising node
  const auto vertex = [&](const std::array<std::uint32_t, 3>& node, const std::array<std::uint32_t, 3>& part) {
    std::array<std::pair<std::uint32_t, std::uint32_t>, 3> order{};
    for (std::size_t k = 0; k < 3; ++k) order[k] = {part[k] == 0 ? ~0u : node[k], part[k]};
    std::sort(order.begin(), order.end());
    std::array<std::uint32_t, 6> key{};
    for (std::size_t k = 0; k < 3; ++k) key[k] = order[k].first, key[k + 3] = order[k].second;
    const auto [at, fresh] = known.insert({key, std::uint32_t(m_places.size())});
    if (fresh) {
      Place p;
      p.node = node;
      for (std::size_t k = 0; k < 3; ++k) p.share[k] = float(part[k]) / float(kParts);
      m_places.push_back(p);
    }
    return at->second;
  };
  for (std::size_t t = 0; t < m_whole.size(); t += 3) {
    const std::array<std::uint32_t, 3> node{m_whole[t], m_whole[t + 1], m_whole[t + 2]};
    const auto at = [&](std::uint32_t i, std::uint32_t j) { return vertex(node, {kParts - i - j, i, j}); };
    for (std::uint32_t j = 0; j < kParts; ++j)
      for (std::uint32_t i = 0; i + j < kParts; ++i) {
        const std::uint32_t up[] = {at(i, j), at(i + 1, j), at(i, j + 1)};
        m_small.insert(m_small.end(), std::begin(up), std::end(up));
        if (i + j + 1 == kParts) continue;
        const std::uint32_t down[] = {at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
        m_small.insert(m_small.end(), std::begin(down), std::end(down));
      }
  }
}

/// All but those of what is torn.
void PouchDrawing::connect(const std::vector<std::uint8_t>& torn) {
  constexpr std::size_t each = 3 * kParts * kParts;
  m_buffer.indices.clear();
  for (std::size_t t = 0; t < torn.size(); ++t)
    if (!torn[t])
      m_buffer.indices.insert(m_buffer.indices.end(), m_small.begin() + std::ptrdiff_t(each * t),
                              m_small.begin() + std::ptrdiff_t(each * (t + 1)));
}

/// Fat grows where it is held; a pattern of its own makes its border uneven.
void PouchDrawing::paint() {
  const tissue::MembraneModel& sheet = m_membrane->sheet;
  const Relief& relief = m_look->relief;
  m_buffer.paint.assign(m_places.size(), Paint{});
  for (std::size_t i = 0; i < m_places.size(); ++i) {
    const Vec3d p = vec_cast<double>(m_buffer.rest[i]);
    double away = 1;
    for (int node : sheet.held_nodes) away = std::min(away, length(sheet.network.rest[std::size_t(node)] - p));
    const double uneven = 0.004 * waves(p, 0.011) + 0.002 * waves(p, 0.004);
    const double fat = smooth(kFatReach, 0.5 * kFatReach, away + uneven);
    m_buffer.paint[i].tint = to_byte(fat);
    m_height[i] = float(relief.broad * waves(p, relief.broad_size) + relief.fine * waves(p, relief.fine_size) +
                        fat * kFatHeight * (1 + 0.6 * waves(p, kFatLobule)));
  }
}

void PouchDrawing::place(const tissue::MembraneState& state) {
  const tissue::MembraneModel& sheet = m_membrane->sheet;
  m_node.resize(std::size_t(sheet.nodes()));
  m_node_normal.resize(m_node.size());
  for (int i = 0; i < sheet.nodes(); ++i)
    m_node[std::size_t(i)] = vec_cast<float>(position(sheet.network, state.network, i));
  render::vertex_normals(m_node, m_whole, m_node_normal);
  m_buffer.positions.resize(m_places.size());
  m_buffer.normals.resize(m_places.size());
  for (std::size_t i = 0; i < m_places.size(); ++i) {
    const Place& at = m_places[i];
    Vec3f flat{}, round{}, normal{};
    for (std::size_t k = 0; k < 3; ++k) flat += at.share[k] * m_node[at.node[k]];
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3f n = m_node_normal[at.node[k]];
      round += at.share[k] * (flat - dot(flat - m_node[at.node[k]], n) * n);
      normal += at.share[k] * n;
    }
    m_buffer.positions[i] =
        flat + kRounded * (round - flat) + (m_height[i] + m_peeled.at(i).high) * normalised(normal, Vec3f{0, 0, 1});
  }
  render::vertex_normals(m_buffer.positions, m_small, m_buffer.normals);
}

/// What has happened to it: heat, peeling, tears.
void PouchDrawing::stain() {
  for (std::size_t i = 0; i < m_places.size(); ++i) {
    m_buffer.paint[i].burn = std::max(m_marks.burn(i), m_peeled.at(i).burn);
    m_buffer.paint[i].blood = m_peeled.at(i).blood;
  }
  constexpr std::size_t each = 3 * kParts * kParts;
  for (std::size_t k = 0; k < m_small.size(); ++k)
    if (m_torn[k / each]) m_buffer.paint[m_small[k]].blood = std::max(m_buffer.paint[m_small[k]].blood, kTornEdge);
}

void PouchDrawing::update(const sim::State& state) {
  place(state.membranes[std::size_t(m_index)]);
  const std::vector<std::uint8_t>& torn = state.torn[std::size_t(m_index)];
  const bool heated = m_marks.update(state), peeled = m_peeled.update(state), parted = torn != m_torn;
  const bool changed = heated || peeled || parted;
  m_torn = torn;
  if (changed) stain();
  if (!parted) {
    if (changed)
      m_mesh.update(m_buffer);
    else
      m_mesh.move(m_buffer.positions, m_buffer.normals);
    return;
  }
  m_buffer.coarser.clear();
  connect(torn);
  m_mesh.replace(m_buffer.data());
}

}  // namespace trocar::view
