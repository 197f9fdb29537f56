#include <algorithm>
#include <cmath>

#include <trocar/interactions/couplings/bonds.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/render/meshes/mesh_arrays.hpp>
#include <trocar/sim/model/bodies.hpp>
#include <trocar/view/objects/fat_drawing.hpp>

namespace trocar::view {
namespace {

constexpr float kCell = 0.0008f;                    // [m] of the grid that the surface is taken from
constexpr double kReach = 1.15;                     // of a lobule's bell, in spacings
constexpr float kMoves = 2e-5f;                     // [m] less is not drawn again
constexpr double kBlanched = 100, kCharred = 215;   // Paint::burn of what is coagulated, and of what is about to go
constexpr double kThreadFrom = 1.7, kThreadTo = 8;  // spacings between which a septum is seen as a thread
constexpr double kThin = 0.00008, kThick = 0.0005;  // [m] a thread's radius in its middle and at its ends
constexpr std::uint32_t kRings = 5, kSides = 4;     // of a thread
constexpr std::size_t kMostThreads = 400;
constexpr float kRootAtMost = 3;    // spacings that a root may be drawn out and still carry a film
constexpr float kNodule = 1.22f;    // of its lobules' size: how large one is drawn
constexpr float kRag = 3;           // septa that hold a lobule: with fewer it is a rag
constexpr double kSmallest = 0.72;  // of its size, without any

std::uint8_t burn_of(const tissue::FatModel& m, const tissue::Lobule& l) {
  if (!l.coagulated()) return 0;
  const double dry = l.boiled / (m.material.water * m.mass);
  return to_byte((kBlanched + (kCharred - kBlanched) * dry) / 255);
}

/// Thick where it leaves a lobule, thin in between.
void add_thread(Vec3d from, Vec3d to, Vec3d rest, std::uint8_t burn, MeshBuffer& b) {
  const Vec3d along = normalised(to - from, Vec3d{0, 0, 1}), u = any_perpendicular(along), v = cross(along, u);
  const std::uint32_t first = b.size();
  for (std::uint32_t r = 0; r < kRings; ++r) {
    const double s = double(r) / (kRings - 1), out = 2 * s - 1;
    const double radius = kThin + (kThick - kThin) * out * out * out * out;
    for (std::uint32_t k = 0; k < kSides; ++k) {
      const double turn = 2 * portable::pi * k / kSides;
      const Vec3d side = std::cos(turn) * u + std::sin(turn) * v;
      b.add(vec_cast<float>(from + s * (to - from) + radius * side), Paint{.burn = burn, .tint = 90});
      b.normals.push_back(vec_cast<float>(side));
      b.rest.push_back(vec_cast<float>(rest + 0.001 * side));
    }
  }
  for (std::uint32_t r = 0; r + 1 < kRings; ++r)
    join_rows(b, first + r * kSides, first + (r + 1) * kSides, kSides, true);
}

void add_threads(const tissue::FatModel& m, const tissue::FatState& s, MeshBuffer& b) {
  std::size_t threads = 0;
  for (int i = 0; i < m.septa() && threads < kMostThreads; ++i) {
    if (holding(m, s, i) <= 0) continue;
    const int a = septum_end(m, i, 0), c = septum_end(m, i, 1);
    const Vec3d from = position(m, s, a), to = position(m, s, c);
    const double apart = length(to - from) / m.spacing;
    if (apart < kThreadFrom || apart > kThreadTo) continue;
    add_thread(from, to, m.network.rest[std::size_t(a)], burn_of(m, s.lobules[std::size_t(a)]), b);
    ++threads;
  }
}

/// A mesh has at least a triangle.
void add_nothing(MeshBuffer& b) {
  for (int k = 0; k < 3; ++k) {
    b.add({});
    b.normals.push_back({0, 0, 1});
    b.rest.push_back({});
  }
  b.triangle(0, 1, 2);
}

}  // namespace

FatDrawing::FatDrawing(const sim::Model& model, render::Backend& backend)
    : m_model(&model), m_areolar(nullptr), m_surface(kCell) {
  const sim::State drawn = sim::initial_state(model);
  std::size_t i = 0;
  for (const interactions::FatBody& body : model.fat) {
    m_areolar = &look(model, "areolar");  // only here: not every set of looks has fat
    Drawn& d = m_bodies.emplace_back();
    d.body = &body;
    d.look = &look(model, body.look);
    for (const interactions::FatNodule& n : body.nodules) d.nodules.push_back({&look(model, n.look), {}, {}});
    draw(d, drawn, drawn.fat[i++]);
    d.mesh = OwnedMesh(backend, m_buffer.data());
    d.veils = OwnedMesh(backend, d.veil_buffer.data());
    for (Drawn::Nodule& n : d.nodules) n.mesh = OwnedMesh(backend, n.buffer.data());
  }
}

bool FatDrawing::moved(const Drawn& d, const tissue::FatState& s) {
  for (std::size_t i = 0; i < d.shown.size(); ++i) {
    const Vec3f off = vec_cast<float>(position(d.body->fat, s, int(i))) - d.shown[i];
    if (dot(off, off) > kMoves * kMoves || d.marks[i] != s.lobules[i].marks) return true;
  }
  return false;
}

void FatDrawing::add_lobules(Drawn& d, const tissue::FatState& s) {
  const tissue::FatModel& m = d.body->fat;
  d.shown.clear(), d.marks.clear(), m_lobules.clear(), m_numbers.clear();
  m_held.assign(std::size_t(m.lobules()), 0);
  for (int i = 0; i < m.septa(); ++i)
    for (int end : {0, 1}) m_held[std::size_t(septum_end(m, i, end))] += float(holding(m, s, i));
  for (int i = 0; i < m.lobules(); ++i) {
    const tissue::Lobule& l = s.lobules[std::size_t(i)];
    const Vec3d p = position(m, s, i), rest = m.network.rest[std::size_t(i)];
    d.shown.push_back(vec_cast<float>(p));
    d.marks.push_back(l.marks);
    if (l.gone() || length(p - rest) > 0.08) continue;  // what has fallen so far is out of sight
    const double rag = std::min(1.0, double(m_held[std::size_t(i)]) / double(kRag));
    const double size = (kSmallest + (1 - kSmallest) * rag) * (1 + 0.16 * (2 * varied(i, 5) - 1));
    m_lobules.push_back({vec_cast<float>(p), vec_cast<float>(rest), float(size * kReach * m.spacing), burn_of(m, l)});
    m_numbers.push_back(i);
  }
}

/// Those lobules are drawn once more, a little larger, as one firm thing: it shows where it lies at the surface.
void FatDrawing::draw_nodules(Drawn& d) {
  for (std::size_t k = 0; k < d.nodules.size(); ++k) {
    const std::vector<std::int32_t>& own = d.body->nodules[k].lobules;
    std::vector<DrawnLobule> lobules;
    for (std::size_t i = 0; i < m_lobules.size(); ++i)
      if (std::find(own.begin(), own.end(), m_numbers[i]) != own.end()) {
        lobules.push_back(m_lobules[i]);
        lobules.back().reach *= kNodule;
      }
    Drawn::Nodule& n = d.nodules[k];
    n.buffer = {};
    m_surface.draw(lobules, n.buffer);
    n.any = !n.buffer.indices.empty();
    if (!n.any) add_nothing(n.buffer);
  }
}

/// By what rags hang on ducts and organs.
void FatDrawing::add_roots(const Drawn& d, const sim::State& state, const tissue::FatState& fat) {
  const tissue::FatModel& m = d.body->fat;
  const interactions::Bodies bodies = sim::bodies_of(*m_model, state);
  const std::size_t set = std::size_t(d.body->roots);
  for (std::size_t i = 0; i < m_model->bonds[set].bonds.size(); ++i) {
    const interactions::Bond& root = m_model->bonds[set].bonds[i];
    if (!state.bonds[set][i].holds() || m_held[std::size_t(root.node())] >= kRag) continue;
    const Vec3d foot = root_of(bodies, root), lobule = position(m, fat, root.node());
    if (length(lobule - foot) > kThreadTo * m.spacing) continue;
    add_thread(foot, lobule, m.network.rest[std::size_t(root.node())],
               burn_of(m, fat.lobules[std::size_t(root.node())]), m_buffer);
  }
}

/// In the gaps between lobules, and to what they are rooted on, as long as that holds.
void FatDrawing::add_veils(Drawn& d, const sim::State& state, const tissue::FatState& fat) const {
  const tissue::FatModel& m = d.body->fat;
  const interactions::Bodies bodies = sim::bodies_of(*m_model, state);
  VeilFrame frame;
  std::vector<int> at(std::size_t(m.lobules()), -1);
  for (std::size_t i = 0; i < m_lobules.size(); ++i) {
    at[std::size_t(m_numbers[i])] = int(i);
    frame.places.push_back(m_lobules[i].place);
    frame.rest.push_back(m_lobules[i].rest);
  }
  const auto link = [&](int a, int b) {
    if (a >= 0 && b >= 0) frame.links.push_back({a, b});
  };
  for (int i = 0; i < m.septa(); ++i)
    if (holding(m, fat, i) > 0) link(at[std::size_t(septum_end(m, i, 0))], at[std::size_t(septum_end(m, i, 1))]);
  const std::size_t set = std::size_t(d.body->roots);
  for (std::size_t i = 0; i < m_model->bonds[set].bonds.size(); ++i) {
    const interactions::Bond& root = m_model->bonds[set].bonds[i];
    const int lobule = at[std::size_t(root.node())];
    const Vec3f foot = vec_cast<float>(root_of(bodies, root));
    if (!state.bonds[set][i].holds() || lobule < 0) continue;
    if (length(foot - frame.places[std::size_t(lobule)]) > kRootAtMost * float(m.spacing)) continue;
    link(lobule, int(frame.places.size()));
    frame.places.push_back(foot);
    frame.rest.push_back(frame.rest[std::size_t(lobule)]);
  }
  d.veil_buffer = {};
  for (const FatVeil& veil : fat_veils(frame, float(m.spacing))) add_veil(frame, veil, float(m.spacing), d.veil_buffer);
  d.veiled = !d.veil_buffer.indices.empty();
  if (!d.veiled) add_nothing(d.veil_buffer);
  render::vertex_normals(d.veil_buffer.positions, d.veil_buffer.indices, d.veil_buffer.normals);
}

void FatDrawing::draw(Drawn& d, const sim::State& state, const tissue::FatState& fat) {
  m_buffer = {};
  add_lobules(d, fat);
  m_surface.draw(m_lobules, m_buffer);
  add_threads(d.body->fat, fat, m_buffer);
  add_roots(d, state, fat);
  d.any = !m_buffer.indices.empty();
  if (!d.any) add_nothing(m_buffer);
  draw_nodules(d);
  add_veils(d, state, fat);
}

void FatDrawing::update(const sim::State& state) {
  const std::vector<tissue::FatState>& now = state.fat;
  for (std::size_t i = 0; i < m_bodies.size(); ++i) {
    if (!moved(m_bodies[i], now[i])) continue;
    draw(m_bodies[i], state, now[i]);
    m_bodies[i].mesh.replace(m_buffer.data());
    m_bodies[i].veils.replace(m_bodies[i].veil_buffer.data());
    for (Drawn::Nodule& n : m_bodies[i].nodules) n.mesh.replace(n.buffer.data());
  }
}

void FatDrawing::list(std::size_t first, const Listing& to) {
  for (std::size_t i = 0; i < m_bodies.size(); ++i) {
    if (m_bodies[i].any) to.add(item(m_bodies[i].mesh.handle(), *m_bodies[i].look, first + i));
    if (m_bodies[i].veiled) to.add(item(m_bodies[i].veils.handle(), *m_areolar, first + i));
    for (const Drawn::Nodule& n : m_bodies[i].nodules)
      if (n.any) to.add(item(n.mesh.handle(), *n.look, first + i));
  }
}

}  // namespace trocar::view
