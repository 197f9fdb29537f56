#include <algorithm>
#include <cmath>
#include <numeric>

#include <trocar/render/meshes/mesh_arrays.hpp>
#include <trocar/view/bodies/cut_ooze.hpp>
#include <trocar/view/bodies/cuttable_drawing.hpp>
#include <trocar/view/bodies/organ_drawing.hpp>

namespace trocar::view {
namespace {

constexpr Paint kCuttableFlesh{220, 235, 0, 0};  // laid bare: raw, as solid right up to the skin as below it
constexpr std::uint8_t kDeepOpenness = 150;      // ... at a cut's bottom: dark, but tissue, no hole
constexpr Paint kCuttableEdge{235, 70, 0,
                              190};  // the capsule's cut edge, drawn back: a thin line of the look's tint ...
constexpr double kEdgeHidden = 70, kEdgeWave = 0.0063;  // ... here and there below blood; [m]
constexpr std::uint8_t kRimBlood = 70;                  // on the skin at a cut's rim, which is wet with it
constexpr std::uint8_t kRimPale = 40;                   // ... and bled out: the look's tint
constexpr float kIntoCut = 0.0035f;           // [m] how far into a cut blood stands behind the lip that it spills over
constexpr std::uint8_t kCover = 235;          // where what wells out of it covers that
constexpr float kStains = 0.0014f;            // [m] how far from a cut its blood stains the skin
constexpr float kCuttableLip = 0.0003f;       // [m] how far its lips are turned out ...
constexpr float kLipAt = 0.0022f;             // [m] ... so far from the rim
constexpr float kRough = 0.3f;                // slope of torn flesh, which breaks up what it mirrors
constexpr std::uint8_t kLooseOpenness = 230;  // of pieces that have detached, which do not lie where they were baked
constexpr std::uint8_t kLoosePale = 60;       // their capsule has bled out
constexpr float kGrain = 0.0007f;             // [m] torn lobules of what is bare
constexpr float kGape = 0.0017f;              // [m] how far either side of a cut draws back
constexpr float kDeepGape = 0.0008f;          // [m] ... below its mouth: a cleft, not a hole below a rim
constexpr float kCuttableFrayed = 0.0006f;    // [m] how far a rim strays from the straight line of its cells
constexpr int kDrawnAlong = 3;                // rings of nodes that go with it

/// Nodes at which the inside is bare: the skin ends there, so it has no relief that would leave a gap.
std::vector<std::uint8_t> rim_nodes(const tissue::FaceSkin& skin, std::size_t nodes) {
  std::vector<std::uint8_t> rim(nodes, 0);
  for (std::size_t i = 0; i < skin.bare.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k)
      if (skin.bare[i] && skin.between[i][k] > 0) rim[std::size_t(skin.corners[i][k])] = 1;
  return rim;
}

/// Nodes of the body's own surface.
std::vector<std::uint8_t> skin_nodes(const tissue::FaceSkin& skin, std::size_t nodes) {
  std::vector<std::uint8_t> own(nodes, 0);
  for (std::size_t i = 0; i < skin.bare.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k)
      if (!skin.bare[i] && skin.between[i][k] > 0) own[std::size_t(skin.corners[i][k])] = 1;
  return own;
}

/// Nodes of pieces that have detached: all but those that hang together with the most.
std::vector<std::uint8_t> loose_nodes(const tissue::FaceSkin& skin, std::size_t nodes) {
  std::vector<int> root(nodes), size(nodes, 0);
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&root](int a) {
    while (root[std::size_t(a)] != a) a = root[std::size_t(a)] = root[std::size_t(root[std::size_t(a)])];
    return a;
  };
  for (const auto& c : skin.corners)
    for (std::size_t k = 1; k < 3; ++k) root[std::size_t(find(c[k]))] = find(c[0]);
  for (const auto& c : skin.corners) ++size[std::size_t(find(c[0]))];
  const int most = int(std::max_element(size.begin(), size.end()) - size.begin());
  std::vector<std::uint8_t> loose(nodes, 0);
  for (std::size_t i = 0; i < nodes; ++i) loose[i] = find(int(i)) != most;
  return loose;
}

float at_rim(const tissue::FaceSkin& skin, const std::vector<std::uint8_t>& rim, std::size_t vertex) {
  float sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t node = std::size_t(skin.corners[vertex][k]);
    if (rim[node]) sum += skin.between[vertex][k];
  }
  return sum;
}

}  // namespace

CuttableDrawing::CuttableDrawing(const sim::CuttableOrgan& organ, Relief relief, render::Backend& backend,
                                 Vec3d gravity)
    : m_organ(&organ),
      m_relief(std::move(relief)),
      m_down(vec_cast<float>(normalised(gravity, Vec3d{0, 0, -1}))),
      m_open(organ.body.drawn.rest.size(), 255) {
  const tissue::CuttableState rest = tissue::rest_state(organ.body);
  make_skin(rest);
  place(rest, {});
  m_mesh = OwnedMesh(backend, {.positions = m_pose.position,
                               .normals = m_normals,
                               .rest = m_skin.skin.rest,
                               .paint = m_paint,
                               .indices = m_indices});
}

void CuttableDrawing::shade(const render::OpennessBaker& baker) {
  std::vector<Paint> paint(m_skin.skin.rest.size());
  baker.bake(m_skin.skin.rest, m_normals, paint);
  for (std::size_t i = 0; i < paint.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k)
      if (m_skin.between[i][k] == 1) m_open[std::size_t(m_skin.corners[i][k])] = paint[i].openness;
  m_version = ~0ull;
}

void CuttableDrawing::make_skin(const tissue::CuttableState& state) {
  const tissue::CuttableModel& body = m_organ->body;
  m_skin = tissue::face_skin(state.tets, body.drawn.across, body.row_of_node, tissue::kDrawnParts);
  m_version = state.version;
  // A double has the openness of the node that it was made from.
  for (std::int32_t i = body.own_nodes; i < state.tets.nodes; ++i)
    m_open[std::size_t(i)] = m_open[std::size_t(state.tets.source[std::size_t(i)])];
  m_pose = tissue::make_pose(m_skin.skin);
  m_indices = flat_indices(m_skin.skin);
  m_loose = loose_nodes(m_skin, m_open.size());
  m_drips.clear();
  find_cut();
  m_shape.find(m_skin);
  paint_skin();
}

/// The bare triangles, and which nodes lie beside each other within a few rings of them.
void CuttableDrawing::find_cut() {
  m_bare.clear();
  m_beside.clear();
  std::vector<std::uint8_t> ring(m_open.size(), 0);
  for (std::size_t t = 0; t + 2 < m_indices.size(); t += 3) {
    const std::array<std::uint32_t, 3> v{m_indices[t], m_indices[t + 1], m_indices[t + 2]};
    if (!m_skin.bare[v[0]] || !m_skin.bare[v[1]] || !m_skin.bare[v[2]]) continue;
    m_bare.push_back(v);
    for (const int node : m_skin.corners[v[0]]) ring[std::size_t(node)] = 1;
  }
  if (m_bare.empty()) return;
  for (int pass = 0; pass < kDrawnAlong; ++pass) {
    std::vector<std::uint8_t> wider = ring;
    for (const auto& c : m_skin.corners)
      if (ring[std::size_t(c[0])] || ring[std::size_t(c[1])] || ring[std::size_t(c[2])])
        for (const int node : c) wider[std::size_t(node)] = 1;
    ring.swap(wider);
  }
  for (const auto& c : m_skin.corners)
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = std::min(c[k], c[(k + 1) % 3]), b = std::max(c[k], c[(k + 1) % 3]);
      if (a != b && ring[std::size_t(a)] && ring[std::size_t(b)]) m_beside.push_back({a, b});
    }
  std::sort(m_beside.begin(), m_beside.end());
  m_beside.erase(std::unique(m_beside.begin(), m_beside.end()), m_beside.end());
}

/// The sides of a cut draw back from each other, most at its mouth, and take the skin around along. Where both sides
/// meet, at its bottom, they pull alike and nothing moves.
void CuttableDrawing::gape() {
  if (m_bare.empty()) return;
  m_gape.assign(m_open.size(), Vec3f{});
  m_gape_weight.assign(m_open.size(), 0);
  for (const auto& v : m_bare) {
    const Vec3f a = m_pose.position[v[0]];
    const Vec3f n = 0.5f * cross(m_pose.position[v[1]] - a, m_pose.position[v[2]] - a);
    for (const std::uint32_t vertex : v)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t node = std::size_t(m_skin.corners[vertex][k]);
        m_gape[node] -= m_skin.between[vertex][k] * n;
        m_gape_weight[node] += m_skin.between[vertex][k] * length(n);
      }
  }
  for (std::size_t i = 0; i < m_gape.size(); ++i)
    if (m_gape_weight[i] > 0) m_gape[i] *= (m_loose[i] ? 0 : (m_mouth[i] ? kGape : kDeepGape)) / m_gape_weight[i];
  const std::vector<float> pulled = m_gape_weight;
  for (int pass = 0; pass < kDrawnAlong; ++pass) {
    m_gape_next.assign(m_gape.size(), Vec3f{});
    m_gape_weight.assign(m_gape.size(), 0);
    for (const auto& [a, b] : m_beside) {
      m_gape_next[std::size_t(a)] += m_gape[std::size_t(b)], m_gape_weight[std::size_t(a)] += 1;
      m_gape_next[std::size_t(b)] += m_gape[std::size_t(a)], m_gape_weight[std::size_t(b)] += 1;
    }
    for (std::size_t i = 0; i < m_gape.size(); ++i) {
      if (!(m_gape_weight[i] > 0)) continue;
      const float own = pulled[i] > 0 ? 0.7f : 0.3f;
      m_gape[i] = own * m_gape[i] + ((1 - own) / m_gape_weight[i]) * m_gape_next[i];
    }
  }
  for (std::size_t i = 0; i < m_pose.position.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k)
      m_pose.position[i] += m_skin.between[i][k] * m_gape[std::size_t(m_skin.corners[i][k])];
}

/// No tissue parts in straight lines. Skin and flesh that meet at a rim have one rest place, so they go together.
void CuttableDrawing::fray() {
  for (std::size_t i = 0; i < m_pose.position.size() && !m_bare.empty(); ++i) {
    if (!m_at_rim[i]) continue;
    const Vec3d p = vec_cast<double>(m_skin.skin.rest[i]);
    const Vec3d off{waves(p, 0.0081), waves(p + Vec3d{0.2, 0.5, 0.1}, 0.0077), waves(p + Vec3d{0.6, 0.3, 0.4}, 0.0073)};
    const Vec3d torn{waves(p, 0.0031), waves(p + Vec3d{0.1, 0.7, 0.2}, 0.0029),
                     waves(p + Vec3d{0.5, 0.2, 0.3}, 0.0033)};
    m_pose.position[i] += kCuttableFrayed * vec_cast<float>(off + 0.5 * torn);
  }
}

void CuttableDrawing::paint_skin() {
  const std::size_t n = m_skin.skin.rest.size();
  m_paint.assign(n, Paint{});
  m_at_rim.clear();
  m_height.clear();
  if (m_relief.any()) m_height = heights(m_relief, m_skin.skin, m_paint);
  if (!m_bare.empty()) m_height.resize(n);
  const std::vector<std::uint8_t> rim = rim_nodes(m_skin, m_open.size());
  m_mouth = skin_nodes(m_skin, m_open.size());
  find_rim();
  for (std::size_t i = 0; i < n; ++i) {
    const bool loose = m_loose[std::size_t(m_skin.corners[i][0])] != 0;
    m_at_rim.push_back(at_rim(m_skin, rim, i) > 0.999f);
    if (m_skin.bare[i]) {
      const Vec3d at = vec_cast<double>(m_skin.skin.rest[i]);
      const float mouth = at_rim(m_skin, m_mouth, i);
      m_height[i] = kGrain * (1 - mouth) * float(waves(at, 0.0027));
      m_paint[i] = kCuttableFlesh;
      m_paint[i].openness = std::uint8_t(float(kDeepOpenness) + mouth * float(kCuttableFlesh.openness - kDeepOpenness));
      if (m_shape.from_rim(i) <= 0) {
        m_paint[i] = kCuttableEdge;
        m_paint[i].blood = std::uint8_t(double(kCuttableEdge.blood) + kEdgeHidden * waves(at, kEdgeWave));
      }
      continue;
    }
    float open = 0;
    for (std::size_t k = 0; k < 3; ++k) open += m_skin.between[i][k] * float(m_open[std::size_t(m_skin.corners[i][k])]);
    m_paint[i].openness = loose ? kLooseOpenness : std::uint8_t(open + 0.5f);
    if (loose) m_paint[i].tint = kLoosePale;
    if (!m_bare.empty()) paint_lip(i, loose);
  }
}

/// The capsule's edge beside a cut: turned out, pale, wet with blood.
void CuttableDrawing::paint_lip(std::size_t vertex, bool loose) {
  const float far = m_shape.from_rim(vertex), off = (far - kLipAt) / kLipAt;
  m_height[vertex] *= std::min(far / (2 * kLipAt), 1.0f);
  if (loose) return;
  if (far > 0) m_height[vertex] += kCuttableLip * std::exp(-off * off);
  const double stain = smooth(double(kStains), 0.0, double(far));
  const double wave = waves(vec_cast<double>(m_skin.skin.rest[vertex]), kEdgeWave);
  m_paint[vertex].blood = std::uint8_t(double(kRimBlood) * (1 + 0.6 * wave) * stain);
  if (far <= 0) m_paint[vertex].tint = std::max(m_paint[vertex].tint, kRimPale);
}

void CuttableDrawing::find_rim() {
  m_rim.clear(), m_around.clear();
  const std::vector<Vec3f>& rest = m_skin.skin.rest;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const bool loose = m_loose[std::size_t(m_skin.corners[i][0])] != 0;
    if (!m_skin.bare[i] && !loose && m_shape.from_rim(i) <= 0) m_rim.push_back(std::uint32_t(i));
  }
  for (std::size_t i = 0; i < rest.size() && !m_rim.empty(); ++i) {
    const auto near = [&](std::uint32_t r) { return length(rest[i] - rest[r]) < kOozeReach; };
    if (!m_skin.bare[i] && std::any_of(m_rim.begin(), m_rim.end(), near)) m_around.push_back(std::uint32_t(i));
  }
}

void CuttableDrawing::list_ooze(render::Liquid& liquid) const {
  liquid.splats.insert(liquid.splats.end(), m_ooze.splats.begin(), m_ooze.splats.end());
}

std::vector<Vec3f> CuttableDrawing::outwards() const {
  std::vector<Vec3f> outwards;
  for (const std::uint32_t v : m_rim) outwards.push_back(m_shape.outwards(v));
  return outwards;
}

/// What runs down from cuts, where they are now.
void CuttableDrawing::run_blood() {
  m_ooze.splats.clear();
  m_ooze.down = m_down;
  const std::vector<Vec3f> drips = view::list_ooze({m_pose.position, m_normals, m_rim, outwards(), m_around}, m_ooze);
  if (m_drips.empty()) m_drips = drips;  // what has fallen stays there when the organ moves
}

/// What has welled up by the time of the cut, and sticks there: it hangs over the cut's lower lip, and stands inside.
void CuttableDrawing::paint_blood() {
  const std::vector<Vec3f>& x = m_pose.position;
  const std::vector<float> sheet = sheet_below({x, m_normals, m_rim, outwards(), m_around}, m_skin.skin.rest, m_down);
  std::vector<std::uint32_t> lip;  // over which it spills
  for (std::size_t k = 0; k < sheet.size(); ++k) {
    cover(m_around[k], double(sheet[k]));
    if (sheet[k] > 0.5f && m_shape.from_rim(m_around[k]) <= 0) lip.push_back(m_around[k]);
  }
  for (std::size_t i = 0; i < x.size() && !lip.empty(); ++i) {
    if (!m_skin.bare[i]) continue;
    float far = kIntoCut;
    for (const std::uint32_t v : lip) far = std::min(far, length(x[v] - x[i]));
    cover(i, smooth(double(kIntoCut), 0.4 * double(kIntoCut), double(far)));
  }
}

/// @param share  of so much blood that nothing shows through
void CuttableDrawing::cover(std::size_t vertex, double share) {
  Paint& p = m_paint[vertex];
  p.blood = std::max(p.blood, std::uint8_t(double(kCover) * share));
  p.tint = std::max(p.tint, to_byte(smooth(0.5, 1.0, share)));  // smooth: no granules
}

void CuttableDrawing::place(const tissue::CuttableState& state, std::span<const collision::Capsule> rods) {
  tissue::pose_skin(view_of(m_organ->body, state), m_skin.skin, m_pose);
  m_shape.smooth(m_pose.position);
  gape();
  fray();
  m_normals.resize(m_pose.position.size());
  render::vertex_normals(m_pose.position, m_indices, m_normals);
  if (!m_height.empty()) {
    for (std::size_t i = 0; i < m_height.size(); ++i) m_pose.position[i] += m_height[i] * m_normals[i];
    render::vertex_normals(m_pose.position, m_indices, m_normals);
  }
  m_box = m_pose.bounds;
  m_dented = near(m_box, rods);
  if (m_dented) {
    const std::vector<Vec3f> before = m_pose.position;
    m_dented = dent(rods, m_pose.position, m_normals);
    for (std::size_t i = 0; i < before.size(); ++i)  // skin and flesh at a rim would part: they have different normals
      if (m_at_rim[i]) m_pose.position[i] = before[i];
  }
  if (m_dented) render::vertex_normals(m_pose.position, m_indices, m_normals);
  run_blood();
  roughen();
}

/// What is bare is torn, not smooth: normals that a flat face does not have break up what it mirrors.
void CuttableDrawing::roughen() {
  if (m_bare.empty()) return;
  for (std::size_t i = 0; i < m_normals.size(); ++i) {
    if (!m_skin.bare[i]) continue;
    const Vec3d p = vec_cast<double>(m_skin.skin.rest[i]);
    const Vec3d off{waves(p, 0.0029), waves(p + Vec3d{0.3, 0.1, 0.2}, 0.0026), waves(p + Vec3d{0.7, 0.5, 0.1}, 0.0031)};
    m_normals[i] = normalised(m_normals[i] + kRough * vec_cast<float>(off), m_normals[i]);
  }
}

void CuttableDrawing::burn(const sim::State& state, HeatMarks& marks) {
  if (!marks.stirred(state)) return;
  m_burnt = true;
  const std::vector<Vec3d> places = below_skin(m_skin.skin);
  for (std::size_t i = 0; i < places.size(); ++i) m_paint[i].burn = marks.burn_at(state, places[i]);
}

void CuttableDrawing::update(const tissue::CuttableState& state, std::span<const collision::Capsule> rods) {
  const bool changed = state.version != m_version;
  if (!m_moved(state.nodes) && !changed && !m_burnt && !m_dented && !near(m_box, rods)) return;
  if (changed) make_skin(state);
  place(state, rods);
  if (changed) paint_blood();
  if (changed)
    m_mesh.replace({.positions = m_pose.position,
                    .normals = m_normals,
                    .rest = m_skin.skin.rest,
                    .paint = m_paint,
                    .indices = m_indices});
  else if (m_burnt)
    m_mesh.repaint(m_pose.position, m_normals, m_paint);
  else
    m_mesh.move(m_pose.position, m_normals);
  m_burnt = false;
}

}  // namespace trocar::view
