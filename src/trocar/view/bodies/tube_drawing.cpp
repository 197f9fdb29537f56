#include <algorithm>
#include <cmath>
#include <cstring>

#include <trocar/interactions/verbs/cut.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/render/meshes/mesh_arrays.hpp>
#include <trocar/view/bodies/fimbria_site.hpp>
#include <trocar/view/bodies/tube_drawing.hpp>

namespace trocar::view {

using interactions::Clip;
using interactions::Cut;

namespace {

constexpr double kBlanched = 0.0030;    // [m] from a clip's middle: blood is pressed out of what its legs hold ...
constexpr double kCongested = 0.0058;   // [m] ... and stands beside that
constexpr double kShade = 0.0014;       // [m] beside a clip's legs, where little light comes
constexpr double kGathered = 0.0028;    // [m] from its middle: there it lies in small folds that run to the legs
constexpr double kLoopStep = 0.0005;    // [m] of a loop's way along a tube, after which its rows are laid again
constexpr double kBloodied = 0.0026;    // [m] beside a cut
constexpr int kTubeFlesh = 20;          // of Paint's blood: a raw face has less where it is muscle and lining
constexpr double kSealedBleeds = 0.35;  // of what smears an open end: blood on the edge of one that a clip closes
constexpr double kStumpSoaked = 0.5,
                 kStumpSoakedFrom = 0.0022;  // how far, and from where [m], such an end has its lining's tint

template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

/// An uneven rim's course, about -1..1.
double ragged(double seed, double angle) {
  return 0.55 * std::sin(2 * angle + 1.9 * seed) + 0.5 * std::sin(3 * angle + 2.6 * seed + 1) +
         0.15 * std::sin(5 * angle + 4.1 * seed + 2);
}

/// 0..1: to one side a stump oozes.
double oozes(double angle) { return smooth(0.1, 0.9, std::sin(angle + 1)); }

}  // namespace

bool TubeDrawing::Layout::same(const Layout& other) const {
  return pieces == other.pieces && same_bytes(clips, other.clips) && same_bytes(nicks, other.nicks) &&
         loops == other.loops;
}

TubeDrawing::TubeDrawing(const sim::Model& model, int strand, const Detail& detail, const WallSurface* walls)
    : m_model(&model),
      m_strand(&model.strands[std::size_t(strand)]),
      m_body(&model.strand_bodies[std::size_t(strand)]),
      m_relief(&look(model, m_strand->look).relief),
      m_index(strand),
      m_marks(model, BodyId::strand(std::size_t(strand))) {
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
  for (const LoopPress& loop : loops_on(m_index, *m_model, state))
    layout.loops.push_back(kLoopStep * std::round(loop.s / kLoopStep));
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
  const tissue::StrandState& now = state.strands[std::size_t(m_index)];
  const bool burnt = m_marks.stirred(state) || (changed && m_marks.any()), was_held = m_held;
  const bool jaws = !jaws_on(BodyId::strand(std::size_t(m_index)), *m_model, state).empty();
  if (!m_moved(now.x) && !changed && !burnt && !jaws && !was_held) return;
  ++m_version;
  const StrandCurve curve(*m_body, now, m_layout.pieces);
  place(curve, m_buffer.positions);
  place_necks(curve);
  m_held = press(state);
  render::vertex_normals(m_buffer.positions, m_buffer.indices, m_buffer.normals);
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
      const double a = 2 * portable::pi * k / m_sides;
      Paint& p = m_buffer.paint[v];
      p.burn = std::max(p.burn, m_marks.burn_at(state, {row.s, r * std::cos(a), r * std::sin(a)}));
    }
  }
}

/// A clip or a loop presses the piece that it sits on, not what was cut off beside it.
template <class Press>
void TubeDrawing::press_piece(const Press& clip) {
  for (std::size_t i = 0; i < m_rows.size(); ++i) {
    const StrandPiece& piece = m_layout.pieces[std::size_t(m_rows[i].piece)];
    if (clip.s < piece.from || clip.s > piece.to) continue;
    const std::size_t end = m_first[i] + std::size_t(m_rows[i].radius == 0 ? 1 : m_sides);
    for (std::size_t v = m_first[i]; v < end; ++v)
      m_buffer.positions[v] = vec_cast<float>(pressed(vec_cast<double>(m_buffer.positions[v]), clip));
  }
}

bool TubeDrawing::press(const sim::State& state) {
  const std::vector<ClipPress> clips = clips_on(m_index, *m_model, state);
  const std::vector<JawPress> jaws = jaws_on(BodyId::strand(std::size_t(m_index)), *m_model, state);
  for (const ClipPress& clip : clips) press_piece(clip);
  for (const LoopPress& loop : loops_on(m_index, *m_model, state)) press_piece(loop);
  for (const JawPress& held : jaws)
    for (Vec3f& p : m_buffer.positions) p = vec_cast<float>(pressed(vec_cast<double>(p), held));
  return !jaws.empty();
}

Paint TubeDrawing::paint_at(const Layout& layout, double s, double angle, Paint own) const {
  Paint p = own;
  const auto press_out = [&](double at, double cover) {
    const double d = std::fabs(s - at);
    const double pale = 0.21 * cover * smooth(kBlanched, 0.0012, d);
    p.burn = std::max(p.burn, to_byte(pale));
    const double red = smooth(0.0018, kBlanched, d) * smooth(kCongested, kBlanched, d);
    p.blood = std::max(p.blood, to_byte(0.19 * cover * red * (0.75 + 0.35 * ragged(m_index, angle))));
    const double shade = smooth(0.5 * kClipLegWidth + kShade, 0.4 * kClipLegWidth, d);
    const double gathered =
        smooth(kGathered, 0.5 * kClipLegWidth, d) * std::max(0.0, ragged(0.37, angle + (s > at ? 0.8 : 0)));
    p.openness = std::uint8_t(p.openness * (1 - cover * std::min(0.9, 0.88 * shade + 0.7 * gathered)));
  };
  for (const Clip& clip : layout.clips) press_out(clip.s, clip.cover);
  for (const double loop : layout.loops) press_out(loop, 1);
  for (const StrandPiece& piece : layout.pieces) {
    if (own.blood > 0) {  // a raw face has its own
      // Its pale flesh is hardly smeared: blood is on the edge and in the lumen.
      const double bleeds = own.blood < kTubeFlesh ? 0.25 : sealed(piece, s < 0.5 * (piece.from + piece.to)) ? 0.4 : 1;
      const double uneven = 95 * oozes(angle) + 26 * ragged(m_index + 0.5, angle);
      p.blood = std::uint8_t(std::clamp(own.blood + bleeds * uneven, 4.0, 255.0));
      break;
    }
    const bool closed_start = sealed(piece, true), closed_end = sealed(piece, false);
    const double stain = kBloodied * std::max(0.15, 0.6 + 0.5 * ragged(m_index + 0.2, angle) + 0.4 * oozes(angle));
    const double much = 0.24 + 0.22 * oozes(angle);
    const auto bleed = [&](double from_end, bool closed) {
      p.blood = std::max(p.blood, to_byte((closed ? kSealedBleeds : 1) * much * smooth(stain, 0, from_end)));
      if (closed) p.tint = std::max(p.tint, to_byte(kStumpSoaked * smooth(kStumpSoakedFrom, 0, from_end)));
    };
    if (piece.cut_start && s >= piece.from) bleed(s - piece.from, closed_start);
    if (piece.cut_end && s <= piece.to) bleed(piece.to - s, closed_end);
  }
  for (const Cut& nick : layout.nicks) {
    const double round = 0.5 + 0.5 * std::cos(angle);
    if (round < nick.fraction + 0.1)
      p.blood = std::max(p.blood, to_byte(smooth(0.0012, 0.0003, std::fabs(s - nick.s))));
  }
  if (hosted(0) && !m_strand->fimbriated) {  // goes over into its organ's colour, which its collar has
    const double radius = m_strand->outer.front(), collar = std::max(m_neck[0].far, 0.3 * radius);
    p.tint = std::max(p.tint, to_byte(0.85 * smooth(collar + 3 * radius, collar, s)));
  }
  return p;
}

void TubeDrawing::lay_out(const Layout& layout) {
  m_layout = layout;
  m_rows.clear();
  for (int piece = 0; piece < int(layout.pieces.size()); ++piece) add_piece(layout, piece);
  connect();
  shape_sections();
  paint();
}

/// Every vertex of a ring, in its frame: that does not change when the strand moves.
void TubeDrawing::shape_sections() {
  m_section.clear();
  for (const TubeRow& row : m_rows)
    for (int k = 0; k < (row.radius == 0 ? 1 : m_sides); ++k) {
      const double a = 2 * portable::pi * k / m_sides;
      const double lobes = row.radius == 0 ? 0 : row.scallop * ragged(row.piece + m_index + row.turn, a);
      const double r = row.radius == 0 ? 0 : row.radius * (outline(row.s, a) + lobes);
      m_section.push_back(
          {r * std::cos(a), r * std::sin(a), (row.along < 0 || row.slant < 0 ? -0.9 : 0.9) * lobes * row.radius});
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
      Paint p = paint_at(m_layout, row.s, 2 * portable::pi * k / m_sides, row.paint);
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
  const Vec3d up = -1.0 * normalised(m_model->gravity, {0, 0, -1});
  std::size_t v = 0;
  for (const TubeRow& row : m_rows) {
    const CurveFrame f = frame_of(row, curve);
    const Vec3d centre = f.point + row.along * f.tangent;
    // Cut by an instrument that comes in from in front: what looks up and towards the endoscope's trocar lies back.
    const Vec3d lean =
        row.slant != 0 ? normalised(normalised(m_model->scope.port - centre, up) + 0.5 * up, up) : Vec3d{};
    for (int k = 0; k < (row.radius == 0 ? 1 : m_sides); ++k, ++v) {
      const Vec3d q = m_section[v], aside = q.x * f.normal + q.y * f.binormal;
      const double beyond = row.slant != 0 ? q.z - row.slant * dot(aside, lean) : q.z;
      positions[v] = vec_cast<float>(centre + aside + beyond * f.tangent);
    }
  }
  if (!m_strand->fimbriated) return;
  const CurveFrame end = curve.at(int(m_layout.pieces.size()) - 1, m_body->length());
  for (const Vec3f& q : m_fimbriae.positions)
    positions[v++] =
        vec_cast<float>(end.point + double(q.x) * end.tangent + double(q.y) * end.normal + double(q.z) * end.binormal);
}

}  // namespace trocar::view
