#include <algorithm>
#include <cmath>
#include <cstring>

#include <trocar/interactions/cut.hpp>
#include <trocar/render/mesh_arrays.hpp>
#include <trocar/view/fimbria_site.hpp>
#include <trocar/view/tube_drawing.hpp>

namespace trocar::view {

using interactions::Clip;
using interactions::Cut;

namespace {

constexpr double kPi = 3.14159265358979;
constexpr double kStep = 0.0012;        // [m] between rings
constexpr double kFineStep = 0.0004;    // [m] near a clip
constexpr double kNearClip = 0.004;     // [m]
constexpr double kBlanched = 0.0034;    // [m] beside a clip's legs
constexpr double kRootFlare = 0.12;     // how much wider a strand is where it grows out of an organ
constexpr double kRootDepth = 1.6;      // radii below the organ's surface where it ends
constexpr double kRootSlide = 0.022;    // [m] a ligament goes on along a wall ...
constexpr double kRootBelow = 0.003;    // [m] ... to below its surface
constexpr double kHeadOn = 0.5;         // sine of the angle to a wall above which a strand has a collar there ...
constexpr double kHeadOnDepth = 0.012;  // [m] ... behind which it ends
constexpr double kWallNeck = 0.008;     // [m] ... from so far above it on
constexpr double kNeckFar = 0.011;      // [m] from its end a strand's collar begins at most
constexpr double kSink = 0.9;           // radii that a strand has sunk into its organ at its end
constexpr double kRootReach = 0.03;     // [m] a wall farther from a fixed end is not its root
constexpr double kBloodied = 0.0016;    // [m] beside a cut
constexpr double kContracts = 0.0022;   // [m] of a cut end
constexpr double kIsthmus = 0.027;      // [m] of a uterine tube that is narrow and straight
constexpr double kCoil = 0.0006;        // [m] its drawn line winds about the simulated one
constexpr double kBend = 0.01;          // [m] radius with which tubes curve, for rings that are left out

template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

/// An uneven rim's course, about -1..1.
double ragged(int seed, double angle) {
  return 0.45 * std::sin(2 * angle + 1.9 * seed) + 0.4 * std::sin(3 * angle + 2.6 * seed + 1) +
         0.35 * std::sin(5 * angle + 4.1 * seed + 2) + 0.2 * std::sin(7 * angle + 0.7 * seed);
}

/// 0..1: to one side a stump oozes.
double oozes(double angle) { return smooth(0.1, 0.9, std::sin(angle + 1)); }

TubeRow row_at(int piece, double s) {
  TubeRow row;
  row.piece = piece;
  row.s = s;
  return row;
}

}  // namespace

bool TubeDrawing::Layout::same(const Layout& other) const {
  return pieces == other.pieces && same_bytes(clips, other.clips) && same_bytes(nicks, other.nicks);
}

TubeDrawing::TubeDrawing(const sim::Model& model, int strand, const Detail& detail, const WallSurface* walls)
    : m_model(&model),
      m_strand(&model.strands[std::size_t(strand)]),
      m_body(&model.bodies[std::size_t(strand)]),
      m_index(strand),
      m_marks(model, strand) {
  const double thickest = *std::max_element(m_strand->outer.begin(), m_strand->outer.end());
  m_sides = thickest > 0.0022 ? 16 : 12;
  for (const sim::DetailLevel& level : detail.levels()) m_errors.push_back(level.error);
  const tissue::StrandState rest = tissue::rest_state(m_body->model);
  const StrandPiece all{0, m_body->nodes() - 1, 0, m_body->length(), false, false};
  const StrandCurve drawn(*m_body, rest, {&all, 1});
  if (m_strand->fimbriated) m_fimbriae = fimbriae(fimbria_site(model, strand, drawn.at(0, m_body->length())));
  coarsen(m_fimbriae, detail, kBends);
  m_start_root = root_at(drawn, true, walls);
  m_end_root = root_at(drawn, false, walls);
  Layout whole;
  whole.pieces = pieces_of(*m_body, rest.alive, {}, m_index);
  lay_out(whole);
  const StrandCurve curve(*m_body, rest, m_layout.pieces);
  place(curve, m_buffer.positions);
  m_neck[0].far = neck_of(curve, true);
  m_neck[1].far = neck_of(curve, false);
  if (walls && m_strand->end.kind == sim::StrandEndModel::fixed) m_neck[1].far = neck_at_wall(curve, false, *walls);
  place_necks(curve);
  m_buffer.rest = m_buffer.positions;
  render::vertex_normals(m_buffer.positions, m_buffer.indices, m_buffer.normals);
}

void TubeDrawing::create(std::vector<Paint> baked, render::Backend& backend) {
  m_baked = std::move(baked);
  m_baked_rows = m_rows;
  paint();
  m_mesh = OwnedMesh(backend, m_buffer.data());
}

TubeDrawing::Layout TubeDrawing::layout_of(const sim::State& state) const {
  Layout layout;
  const std::span<const Cut> cuts(state.cuts.data(), std::size_t(state.cut_count));
  layout.pieces = pieces_of(*m_body, state.strands[std::size_t(m_index)].alive, cuts, m_index);
  for (int i = 0; i < state.clip_count; ++i)
    if (state.clips[std::size_t(i)].strand == m_index) layout.clips.push_back(state.clips[std::size_t(i)]);
  for (const Cut& cut : cuts)
    if (cut.strand == m_index && cut.fraction < interactions::kThrough) layout.nicks.push_back(cut);
  return layout;
}

void TubeDrawing::update(const sim::State& state) {
  const Layout layout = layout_of(state);
  const bool changed = !layout.same(m_layout);
  if (changed) {
    lay_out(layout);
    // Rest coordinates come from the drawn strand, cut or not: patterns stay where they were.
    const tissue::StrandState rest = tissue::rest_state(m_body->model);
    place(StrandCurve(*m_body, rest, m_layout.pieces), m_buffer.rest);
  }
  const StrandCurve curve(*m_body, state.strands[std::size_t(m_index)], m_layout.pieces);
  place(curve, m_buffer.positions);
  place_necks(curve);
  press(state);
  render::vertex_normals(m_buffer.positions, m_buffer.indices, m_buffer.normals);
  const bool burnt = m_marks.stirred(state) || (changed && m_marks.any());
  if (burnt) burn(state);
  if (changed)
    m_mesh.replace(m_buffer.data());
  else if (burnt)
    m_mesh.update(m_buffer);
  else
    m_mesh.move(m_buffer.positions, m_buffer.normals);
}

void TubeDrawing::burn(const sim::State& state) {
  paint();
  std::size_t v = 0;
  for (const TubeRow& row : m_rows) {
    const double r = 0.85 * std::min(row.radius, radius_at(row.s));
    for (int k = 0; k < (row.radius == 0 ? 1 : m_sides); ++k, ++v) {
      if (row.out > 0) continue;
      const double a = 2 * kPi * k / m_sides;
      Paint& p = m_buffer.paint[v];
      p.burn = std::max(p.burn, m_marks.burn_at(state, {row.s, r * std::cos(a), r * std::sin(a)}));
    }
  }
}

void TubeDrawing::press(const sim::State& state) {
  for (const ClipPress& clip : clips_on(m_index, *m_model, state))
    for (Vec3f& p : m_buffer.positions) p = vec_cast<float>(pressed(vec_cast<double>(p), clip));
  for (const JawPress& jaws : jaws_on(m_index, *m_model, state))
    for (Vec3f& p : m_buffer.positions) p = vec_cast<float>(pressed(vec_cast<double>(p), jaws));
}

double TubeDrawing::radius_at(double s) const {
  const interactions::StrandPlace at = place_at(*m_body, s);
  const std::size_t e = std::size_t(at.element), n = m_strand->outer.size();
  const std::vector<double>& r = m_strand->outer;
  const double a = r[e > 0 ? e - 1 : 0], b = r[e], c = r[e + 1], d = r[std::min(e + 2, n - 1)], w = at.w;
  // Uniform cubic B-spline: rounds the corners of the stations.
  const double u = 1 - w;
  double radius =
      (u * u * u * a + (3 * w * w * w - 6 * w * w + 4) * b + (3 * u * u * u - 6 * u * u + 4) * c + w * w * w * d) / 6;
  if (m_strand->fimbriated) radius *= bell_flare(m_body->length() - s) * bore(s);
  if (hosted(0)) radius *= 1 + kRootFlare * std::exp(-s / (0.9 * r.front()));
  if (hosted(m_body->nodes() - 1)) radius *= 1 + kRootFlare * std::exp(-(m_body->length() - s) / (0.9 * r.back()));
  return radius;
}

/// How much of a uterine tube's windings a place has: none in the isthmus and where it opens.
double TubeDrawing::winding(double s) const {
  if (!m_strand->fimbriated) return 0;
  const double length = m_body->length();
  return smooth(kIsthmus, kIsthmus + 0.014, s) * smooth(length, length - 0.012, s);
}

/// Its bore is uneven: wide places and waists that are drawn, not simulated.
double TubeDrawing::bore(double s) const {
  const double k = 2 * kPi * s, seed = 2.3 * m_index;
  const double ampulla = 0.085 * std::sin(k / 0.0173 + seed) + 0.05 * std::sin(k / 0.0097 + 1.7 * seed + 1);
  return 1 + winding(s) * ampulla + 0.03 * std::sin(k / 0.0071 + seed);
}

/// And so is its way: it coils gently about the simulated line.
Vec3d TubeDrawing::coiled(double s, const CurveFrame& f) const {
  const double k = 2 * kPi * s, seed = 2.3 * m_index, amount = kCoil * winding(s);
  if (amount <= 0) return {};
  const double a = std::sin(k / 0.0208 + seed) + 0.4 * std::sin(k / 0.0117 + 2 * seed),
               b = std::cos(k / 0.0241 + 1.4 * seed) + 0.4 * std::sin(k / 0.0133 + seed);
  return amount * (a * f.normal + b * f.binormal);
}

double TubeDrawing::outline(double s, double angle) const {
  const double k = 2 * kPi * s, seed = 1.7 * m_index;
  return 1 + 0.035 * std::sin(k / 0.0093 + 1.6 * std::sin(angle + seed)) +
         0.03 * std::sin(2 * angle + k / 0.017 + seed) + 0.018 * std::sin(3 * angle - k / 0.0061 + 2 * seed);
}

bool TubeDrawing::hosted(int node) const {
  const sim::StrandEndModel& end = node == 0 ? m_strand->start : m_strand->end;
  return end.kind == sim::StrandEndModel::hosted;
}

TubeRoot TubeDrawing::root_at(const StrandCurve& rest, bool at_start, const WallSurface* walls) const {
  const sim::StrandEndModel& end = at_start ? m_strand->start : m_strand->end;
  if (end.kind == sim::StrandEndModel::free) return {};
  const CurveFrame f = rest.at(0, at_start ? 0 : m_body->length());
  const double radius = at_start ? m_strand->outer.front() : m_strand->outer.back();
  if (end.kind == sim::StrandEndModel::fixed) {
    const Vec3d onward = at_start ? -f.tangent : f.tangent;
    return walls ? root_in_wall(f, onward, radius, *walls) : root_in_wall(f, onward, radius, WallSurface(*m_model));
  }
  double nearest = 1;
  Vec3d at{}, normal{};
  const std::size_t organ = std::size_t(end.organ);
  const tissue::Skin& skin = organ < m_model->solids.size() ? m_model->solids[organ].fine : m_model->skin(end.organ);
  for (std::size_t i = 0; i < skin.rest.size(); ++i) {
    if (!skin.at_surface(int(i))) continue;
    const double d = length(vec_cast<double>(skin.rest[i]) - f.point);
    if (d >= nearest) continue;
    nearest = d;
    at = vec_cast<double>(skin.rest[i]);
    normal = vec_cast<double>(skin.rest_normal[i]);
  }
  TubeRoot root;
  const double above = dot(f.point - at, normal);
  root.sink = std::max(0.0, kSink * radius + above);
  at = f.point - above * normal;
  root.there = true;
  const Vec3d target = at - (kRootDepth * radius) * normal;
  root.length = length(target - f.point);
  const auto local = [&f](Vec3d v) { return Vec3d{dot(v, f.tangent), dot(v, f.normal), dot(v, f.binormal)}; };
  root.target = local(target - f.point);
  root.direction = local(-normal);
  return root;
}

/// A ligament does not end where it meets a wall, but runs on below the peritoneum and is lost there.
TubeRoot TubeDrawing::root_in_wall(const CurveFrame& end, Vec3d onward, double radius, const WallSurface& walls) const {
  TubeRoot root;
  root.there = root.in_space = true;
  const WallSurface::Place wall = walls.nearest(end.point);
  const bool near = wall.there && length(wall.point - end.point) <= kRootReach;
  if (!near || dot(onward, wall.normal) < -kHeadOn) {  // on into the dark
    root.direction = onward;
    root.target = end.point + (near ? kHeadOnDepth : kRootReach) * onward;
  } else {
    const Vec3d level = normalised(onward - dot(onward, wall.normal) * wall.normal, any_perpendicular(wall.normal));
    root.target = wall.point + kRootSlide * level - (radius + kRootBelow) * wall.normal;
    root.direction = normalised(level - 0.3 * wall.normal);
  }
  root.length = length(root.target - end.point);
  return root;
}

/// How far from its end the whole ring lies outside the organ, with room for a collar [m].
double TubeDrawing::neck_of(const StrandCurve& rest, bool at_start) const {
  const int node = at_start ? 0 : m_body->nodes() - 1;
  const sim::StrandEndModel& end = at_start ? m_strand->start : m_strand->end;
  if (!hosted(node) || std::size_t(end.organ) >= m_model->solids.size()) return 0;
  const tissue::Skin& skin = m_model->solids[std::size_t(end.organ)].fine;
  const double radius = m_strand->outer[std::size_t(node)];
  for (double far = 1.2 * radius; far < std::min(kNeckFar, 0.3 * m_body->length()); far += 0.0005) {
    const CurveFrame f = frame_of(row_at(0, at_start ? far : m_body->length() - far), rest);
    double nearest = 1, above = 0;
    for (std::size_t i = 0; i < skin.rest.size(); ++i) {
      const Vec3d way = f.point - vec_cast<double>(skin.rest[i]);
      if (const double d = length(way); d < nearest) {
        nearest = d;
        above = dot(way, vec_cast<double>(skin.rest_normal[i]));
      }
    }
    if (above > 1.5 * radius) return far + 0.6 * radius;
  }
  return std::min(kNeckFar, 0.3 * m_body->length());
}

/// One that meets a wall head-on needs a collar there, too.
double TubeDrawing::neck_at_wall(const StrandCurve& rest, bool at_start, const WallSurface& walls) const {
  const double end = at_start ? 0 : m_body->length();
  const CurveFrame f = rest.at(0, end);
  const WallSurface::Place wall = walls.nearest(f.point);
  const double steep = dot(at_start ? f.tangent : -f.tangent, wall.normal);
  if (!wall.there || length(wall.point - f.point) > kRootReach || steep < kHeadOn) return 0;
  const double above = dot(f.point - wall.point, wall.normal), far = (kWallNeck - above) / steep;
  return std::clamp(far, 0.002, 0.3 * m_body->length());
}

void TubeDrawing::place_necks(const StrandCurve& curve) {
  for (const bool at_start : {true, false}) {
    TubeNeck& neck = m_neck[at_start ? 0 : 1];
    if (neck.far <= 0) continue;
    const int index = at_start ? 0 : int(m_layout.pieces.size()) - 1;
    const StrandPiece& piece = m_layout.pieces[std::size_t(index)];
    const double s = at_start ? neck.far : m_body->length() - neck.far;
    neck.there = at_start ? piece.to > s && piece.from <= 0 : piece.from < s && piece.to >= m_body->length();
    const CurveFrame f = frame_of(row_at(index, s), curve);
    neck.centre = f.point;
    neck.along = at_start ? -f.tangent : f.tangent;
    neck.end = curve.at(index, at_start ? 0 : m_body->length()).point;
    neck.radius = radius_at(s);
    neck.ring.clear();
    for (int k = 0; k < m_sides; ++k) {
      const double a = 2 * kPi * k / m_sides;
      neck.ring.push_back(vec_cast<float>(f.point + (neck.radius * outline(s, a)) *
                                                        (std::cos(a) * f.normal + std::sin(a) * f.binormal)));
    }
  }
}

/// From the end inwards; for a start in reversed order, so that rows always follow the strand.
void TubeDrawing::add_root(int piece, bool at_start) {
  const StrandPiece& p = m_layout.pieces[std::size_t(piece)];
  const TubeRoot& root = at_start ? m_start_root : m_end_root;
  const double s = at_start ? p.from : p.to, r = radius_at(s), narrows = root.in_space ? 0.3 : 0.7;
  const int steps = std::max(3, int(root.length / 0.0015));
  std::vector<TubeRow> rows;
  for (int i = 1; i <= steps; ++i) {
    const double t = double(i) / steps;
    rows.push_back({piece, s, 0, r * (1 - narrows * t * t), 0, t, false, {to_byte(1 - 0.35 * t), 0, 0, 0}});
  }
  rows.push_back({piece, s, 0, 0, 0, 1, false, {120, 0, 0, 0}});
  if (at_start) std::reverse(rows.begin(), rows.end());
  m_rows.insert(m_rows.end(), rows.begin(), rows.end());
}

/// Near an organ the tube lies half in its surface, so that it grows out of it instead of standing on it.
CurveFrame TubeDrawing::sunk(const TubeRow& row, CurveFrame f, const StrandCurve& curve) const {
  for (const bool at_start : {true, false}) {
    const TubeRoot& root = at_start ? m_start_root : m_end_root;
    if (!root.there || root.in_space) continue;
    const double end = at_start ? 0 : m_body->length(), far = std::fabs(row.s - end);
    const int piece = at_start ? 0 : int(m_layout.pieces.size()) - 1;
    if (row.piece != piece || far > 4 * root.sink) continue;
    const CurveFrame e = curve.at(piece, end);
    const Vec3d in = root.direction.x * e.tangent + root.direction.y * e.normal + root.direction.z * e.binormal;
    f.point += (root.sink * smooth(4 * root.sink, 0, far)) * in;
  }
  return f;
}

/// The curve's frame, or beyond an end that of the way to the root's target.
CurveFrame TubeDrawing::frame_of(const TubeRow& row, const StrandCurve& curve) const {
  CurveFrame f = curve.at(row.piece, row.s);
  if (row.out <= 0) {
    f.point += coiled(row.s, f);
    return sunk(row, f, curve);
  }
  const bool at_start = row.piece == 0 && row.s == curve.pieces().front().from;
  const TubeRoot& root = at_start ? m_start_root : m_end_root;
  const double sign = at_start ? -1 : 1;
  const auto world = [&f](Vec3d v) { return v.x * f.tangent + v.y * f.normal + v.z * f.binormal; };
  if (!root.in_space) f.point += root.sink * world(root.direction);
  const Vec3d a = f.point, b = root.in_space ? root.target : a + world(root.target);
  const Vec3d da = (sign * root.length) * f.tangent,
              db = root.length * (root.in_space ? root.direction : world(root.direction));
  const double t = row.out, u = 1 - t;
  f.point = (u * u * (1 + 2 * t)) * a + (t * t * (3 - 2 * t)) * b + (u * u * t) * da - (t * t * u) * db;
  const Vec3d along = (6 * t * u) * (b - a) + (u * (1 - 3 * t)) * da + (t * (3 * t - 2)) * db;
  f.tangent = normalised(sign * along, f.tangent);
  f.normal = normalised(f.normal - dot(f.normal, f.tangent) * f.tangent, any_perpendicular(f.tangent));
  f.binormal = cross(f.tangent, f.normal);
  return f;
}

Paint TubeDrawing::paint_at(const Layout& layout, double s, double angle, Paint own) const {
  Paint p = own;
  for (const Clip& clip : layout.clips) {
    const double d = std::fabs(s - clip.s);
    const double pale = 0.13 * clip.cover * smooth(kBlanched, 0.0008, d);
    p.burn = std::max(p.burn, to_byte(pale));
  }
  for (const StrandPiece& piece : layout.pieces) {
    if (own.blood > 0) {  // a raw face has its own
      p.blood = std::uint8_t(std::min(255.0, own.blood + 95 * oozes(angle)));
      break;
    }
    const double stain = kBloodied * (0.8 + 0.6 * std::sin(angle + 1) + 0.4 * std::sin(3 * angle));
    const double much = 0.2 + 0.3 * oozes(angle);
    if (piece.cut_start && s >= piece.from)
      p.blood = std::max(p.blood, to_byte(much * smooth(stain, 0, s - piece.from)));
    if (piece.cut_end && s <= piece.to) p.blood = std::max(p.blood, to_byte(much * smooth(stain, 0, piece.to - s)));
  }
  for (const Cut& nick : layout.nicks) {
    const double round = 0.5 + 0.5 * std::cos(angle);
    if (round < nick.fraction + 0.1)
      p.blood = std::max(p.blood, to_byte(smooth(0.0012, 0.0003, std::fabs(s - nick.s))));
  }
  if (hosted(0) && !m_strand->fimbriated)  // goes over into its organ's colour
    p.tint = std::max(p.tint, to_byte(0.85 * smooth(4 * m_strand->outer.front(), 0.3 * m_strand->outer.front(), s)));
  return p;
}

std::vector<double> TubeDrawing::stations(const Layout& layout, const StrandPiece& piece) const {
  std::vector<double> at;
  const int steps = std::max(2, int(std::ceil((piece.to - piece.from) / kStep)));
  for (int i = 0; i <= steps; ++i) at.push_back(piece.from + (piece.to - piece.from) * i / steps);
  for (const Clip& clip : layout.clips)
    for (double d = -kNearClip; d <= kNearClip; d += kFineStep)
      if (clip.s + d > piece.from + 1e-5 && clip.s + d < piece.to - 1e-5) at.push_back(clip.s + d);
  std::sort(at.begin(), at.end());
  at.erase(std::unique(at.begin(), at.end(), [](double a, double b) { return b - a < 1e-5; }), at.end());
  at.back() = piece.to;
  return at;
}

void TubeDrawing::add_raw_face(int piece, bool at_start) {
  const StrandPiece& p = m_layout.pieces[std::size_t(piece)];
  const double s = at_start ? p.from : p.to, sign = at_start ? -1 : 1, r = radius_at(s) * contracted(p, s);
  const double open = m_strand->inner.empty() ? 0 : m_strand->inner[std::size_t(at_start ? p.first : p.last)];
  const double lumen = std::max(open, 0.22 * r);
  // The serosa has drawn back from a pale ring of muscle, which has contracted; out of it pouts the lining, ragged and
  // dusky, around a narrow dark lumen.
  const Paint rim{235, 20, 0, 0}, muscle{225, 8, 24, 20}, mucosa{205, 12, 0, 215}, lining{150, 60, 0, 255};
  const Paint dark{40, 190, 0, 255};
  std::vector<TubeRow> rows;
  const auto row = [&](double along, double radius, double ragged, Paint paint) {
    rows.push_back({piece, s, sign * along, radius, ragged, 0, false, paint});
  };
  row(0, r, 0, rim);
  row(0.05 * r, 0.94 * r, 0.05, muscle);
  row(0.13 * r, 0.85 * r, 0.05, muscle);
  row(0.22 * r, 0.89 * r, 0.10, mucosa);
  row(0.38 * r, 0.96 * r, 0.17, mucosa);
  row(0.52 * r, 0.90 * r, 0.20, mucosa);
  row(0.54 * r, 0.74 * r, 0.17, mucosa);
  row(0.45 * r, std::min(1.3 * lumen, 0.54 * r), 0.12, lining);
  row(0.18 * r, std::min(0.9 * lumen, 0.38 * r), 0.05, dark);
  row(-0.4 * r, 0, 0, dark);
  rows.front().crease = !at_start;
  if (at_start) std::reverse(rows.begin(), rows.end());
  m_rows.insert(m_rows.end(), rows.begin(), rows.end());
}

void TubeDrawing::add_start(int piece) {
  const StrandPiece& p = m_layout.pieces[std::size_t(piece)];
  if (p.cut_start) return add_raw_face(piece, true);
  const double r = radius_at(p.from);
  if (m_start_root.there) return add_root(piece, true);
  m_rows.push_back({piece, p.from, -r, 0, 0, 0, false, {}});
  for (const double a : {0.3, 0.7, 1.1})
    m_rows.push_back({piece, p.from, -r * std::cos(a), r * std::sin(a), 0, 0, false, {}});
}

void TubeDrawing::add_end(int piece) {
  const StrandPiece& p = m_layout.pieces[std::size_t(piece)];
  if (p.cut_end) return add_raw_face(piece, false);
  const double r = radius_at(p.to);
  if (m_strand->fimbriated) return;  // goes over into the fimbriae
  if (m_end_root.there) return add_root(piece, false);
  for (const double a : {1.1, 0.7, 0.3})
    m_rows.push_back({piece, p.to, r * std::cos(a), r * std::sin(a), 0, 0, false, {}});
  m_rows.push_back({piece, p.to, r, 0, 0, 0, false, {}});
}

/// Its muscle narrows a cut end.
double TubeDrawing::contracted(const StrandPiece& piece, double s) const {
  double amount = 0;
  if (piece.cut_start) amount = smooth(kContracts, 0, s - piece.from);
  if (piece.cut_end) amount = std::max(amount, smooth(kContracts, 0, piece.to - s));
  return 1 - 0.12 * amount;
}

void TubeDrawing::add_piece(const Layout& layout, int piece) {
  const StrandPiece& p = layout.pieces[std::size_t(piece)];
  add_start(piece);
  bool first = true;
  for (const double s : stations(layout, p)) {
    m_rows.push_back({piece, s, 0, radius_at(s) * contracted(p, s), 0, 0, first && p.cut_start, {}});
    first = false;
  }
  add_end(piece);
}

void TubeDrawing::lay_out(const Layout& layout) {
  m_layout = layout;
  m_rows.clear();
  for (int piece = 0; piece < int(layout.pieces.size()); ++piece) add_piece(layout, piece);
  connect();
  paint();
}

void TubeDrawing::connect() {
  m_buffer = {};
  m_first.clear();
  std::vector<std::size_t> all;
  for (const TubeRow& row : m_rows) {
    all.push_back(all.size());
    m_first.push_back(m_buffer.size());
    for (int k = 0; k < (row.radius == 0 ? 1 : m_sides); ++k) m_buffer.add({});
  }
  join(all, 1, m_buffer);
  const std::uint32_t fingers = m_buffer.size();
  if (m_strand->fimbriated) {
    join_fimbriae(fingers, 1, m_buffer);
    append(m_buffer, m_fimbriae, Mat3f::identity(), {});
  }
  connect_coarsely();
  for (std::size_t k = 0; k < m_fimbriae.coarser.size(); ++k)
    for (const std::uint32_t v : m_fimbriae.coarser[k]) m_buffer.coarser[k].push_back(fingers + v);
}

/// Between every `stride`-th side of the last row and the fimbriae's first ring, which has more vertices.
void TubeDrawing::join_fimbriae(std::uint32_t fingers, std::uint32_t stride, MeshBuffer& into) const {
  const auto sides = std::uint32_t(m_sides), fine = std::uint32_t(kRimColumns) / sides * stride;
  static_assert(kRimColumns % 16 == 0 && kRimColumns % 12 == 0);
  const auto ring = [&](std::uint32_t k) { return fingers + k % std::uint32_t(kRimColumns); };
  for (std::uint32_t i = 0; i < sides; i += stride) {
    const std::uint32_t a = m_first.back() + i, b = m_first.back() + (i + stride) % sides;
    const std::uint32_t from = i / stride * fine, half = fine / 2;
    for (std::uint32_t k = 0; k < fine; ++k) into.triangle(k < half ? a : b, ring(from + k + 1), ring(from + k));
    into.triangle(a, b, ring(from + half));
  }
}

/// Triangles between these rows, of every `stride`-th side.
void TubeDrawing::join(const std::vector<std::size_t>& rows, std::uint32_t stride, MeshBuffer& into) const {
  const auto sides = std::uint32_t(m_sides);
  for (std::size_t n = 1; n < rows.size(); ++n) {
    const TubeRow &low = m_rows[rows[n - 1]], &high = m_rows[rows[n]];
    if (high.piece != low.piece || high.crease) continue;
    const std::uint32_t a = m_first[rows[n - 1]], b = m_first[rows[n]];
    for (std::uint32_t i = 0; i < sides; i += stride) {
      const std::uint32_t j = (i + stride) % sides;
      if (high.radius == 0)
        into.triangle(a + i, a + j, b);
      else if (low.radius == 0)
        into.triangle(b + j, b + i, a);
      else
        into.quad(a + i, a + j, b + j, b + i);
    }
  }
}

/// Plain rows at least so far apart [m], and all that are not plain.
std::vector<std::size_t> TubeDrawing::rows_apart(double distance) const {
  const auto plain = [](const TubeRow& r) { return r.radius > 0 && r.along == 0 && r.out == 0 && !r.crease; };
  const auto clipped = [this](double s) {
    return std::any_of(m_layout.clips.begin(), m_layout.clips.end(),
                       [s](const Clip& clip) { return std::fabs(clip.s - s) < kNearClip; });
  };
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < m_rows.size(); ++i) {
    const TubeRow& row = m_rows[i];
    const bool inside = i > 0 && i + 1 < m_rows.size() && plain(row) && plain(m_rows[i - 1]) && plain(m_rows[i + 1]) &&
                        m_rows[i - 1].piece == row.piece && m_rows[i + 1].piece == row.piece;
    const double least = clipped(row.s) ? 0.3 * distance : distance;
    if (!inside || row.s - m_rows[kept.back()].s > least - 0.5 * kFineStep) kept.push_back(i);
  }
  return kept;
}

void TubeDrawing::connect_coarsely() {
  const double thickest = *std::max_element(m_strand->outer.begin(), m_strand->outer.end());
  for (const double error : m_errors) {
    MeshBuffer part;
    const std::uint32_t stride = side_stride(error, thickest, std::uint32_t(m_sides));
    join(rows_apart(ring_distance(error, kBend)), stride, part);
    if (m_strand->fimbriated) join_fimbriae(m_buffer.size() - m_fimbriae.size(), stride, part);
    m_buffer.coarser.push_back(std::move(part.indices));
  }
}

void TubeDrawing::paint() {
  const auto shaded = [](Paint p, Paint baked) {
    p.openness = std::uint8_t(p.openness * baked.openness / 255);
    return p;
  };
  std::size_t v = 0;
  for (const TubeRow& row : m_rows) {
    const bool on_tube = row.along == 0 && row.out == 0 && row.paint.blood == 0 && !m_baked.empty();
    const std::size_t baked = on_tube ? nearest_first(row.s) : 0;
    for (int k = 0; k < (row.radius == 0 ? 1 : m_sides); ++k) {
      Paint p = paint_at(m_layout, row.s, 2 * kPi * k / m_sides, row.paint);
      if (on_tube) p = shaded(p, m_baked[baked + std::size_t(k)]);
      m_buffer.paint[v++] = p;
    }
  }
  const std::size_t fingers = m_fimbriae.paint.size();
  const auto thin = [](Paint baked) {  // leaves let light through to each other
    baked.openness = std::uint8_t(110 + 145 * baked.openness / 255);
    return baked;
  };
  for (std::size_t i = 0; i < fingers; ++i)
    m_buffer.paint[v + i] = m_baked.empty() ? m_fimbriae.paint[i]
                                            : shaded(m_fimbriae.paint[i], thin(m_baked[m_baked.size() - fingers + i]));
}

std::size_t TubeDrawing::nearest_first(double s) const {
  std::size_t best = 0, first = 0;
  double gap = 1e9;
  for (const TubeRow& row : m_baked_rows) {
    if (row.radius > 0 && row.along == 0 && row.out == 0 && std::fabs(row.s - s) < gap) {
      gap = std::fabs(row.s - s);
      best = first;
    }
    first += row.radius == 0 ? 1 : std::size_t(m_sides);
  }
  return best;
}

void TubeDrawing::place(const StrandCurve& curve, std::vector<Vec3f>& positions) const {
  positions.resize(m_buffer.paint.size());
  std::size_t v = 0;
  for (const TubeRow& row : m_rows) {
    const CurveFrame f = frame_of(row, curve);
    const Vec3d centre = f.point + row.along * f.tangent;
    if (row.radius == 0) {
      positions[v++] = vec_cast<float>(centre);
      continue;
    }
    for (int k = 0; k < m_sides; ++k) {
      const double a = 2 * kPi * k / m_sides;
      const double lobes = row.scallop * ragged(row.piece + m_index, a);
      const double r = row.radius * (outline(row.s, a) + lobes);
      const Vec3d p = centre + r * (std::cos(a) * f.normal + std::sin(a) * f.binormal) +
                      (row.along < 0 ? -1 : 1) * (0.9 * lobes * row.radius) * f.tangent;
      positions[v++] = vec_cast<float>(p);
    }
  }
  if (!m_strand->fimbriated) return;
  const CurveFrame end = curve.at(int(m_layout.pieces.size()) - 1, m_body->length());
  for (const Vec3f& q : m_fimbriae.positions)
    positions[v++] =
        vec_cast<float>(end.point + double(q.x) * end.tangent + double(q.y) * end.normal + double(q.z) * end.binormal);
}

}  // namespace trocar::view
