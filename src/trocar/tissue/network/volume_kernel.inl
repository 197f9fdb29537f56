// One impulse of the volume force (volume_force.hpp), for one instruction set. Included by network_kernel.inl.
//
// Cells sit in lanes: their corners' places are loaded whole and transposed, what a cell says and does is put down for
// its corners, and each row picks up what the cells around it have left, in their order. So every width, and a loop
// over cells that adds to their corners, give the same bits.

namespace trocar::tissue {
namespace {

constexpr float kLeast = 0.5f, kMost = 2;     // of J: beyond, cells are the guard's and the law's business
constexpr float kCrushed = 0.2f, kBurst = 4;  // of a cell's volume: beyond, nothing presses on it any more
constexpr float kQuickest = 0.5f;             // of what one cell gives a node in an impulse [m/s]

TROCAR_INLINE Triple cross(const Triple& a, const Triple& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
TROCAR_INLINE V dot(const Triple& a, const Triple& b) { return (a.x * b.x + a.y * b.y) + a.z * b.z; }
TROCAR_INLINE Triple operator*(V f, const Triple& a) { return {f * a.x, f * a.y, f * a.z}; }
TROCAR_INLINE V within(V a, float least, float most) { return smaller(larger(a, all(least)), all(most)); }

/// Cells as they are: what goes with their corners' places, six times their volume, and the volume's derivatives.
struct CellsNow {
  V w[4];
  V volume6;
  Triple by[4];
};
TROCAR_INLINE CellsNow cells_now(const VolumeArgs& arg, int pack, int part) {
  const char* const places = reinterpret_cast<const char*>(arg.places);
  const CornerPack& corners = arg.corners[pack];
  const Quads o = load_quads(places, corners.offset[0] + part), p = load_quads(places, corners.offset[1] + part);
  const Quads q = load_quads(places, corners.offset[2] + part), r = load_quads(places, corners.offset[3] + part);
  const Triple a = p.xyz - o.xyz, b = q.xyz - o.xyz, c = r.xyz - o.xyz;
  CellsNow cells;
  cells.w[0] = o.w, cells.w[1] = p.w, cells.w[2] = q.w, cells.w[3] = r.w;
  cells.by[1] = cross(b, c), cells.by[2] = cross(c, a), cells.by[3] = cross(a, b);
  const Triple sum = cells.by[1] + cells.by[2] + cells.by[3];
  cells.by[0] = {-sum.x, -sum.y, -sum.z};
  cells.volume6 = dot(a, cells.by[1]);
  return cells;
}

TROCAR_INLINE I gone(const VolumeArgs& arg, int first) {
  I mask{};
  if (!arg.phase) return mask;
  for (int i = 0; i < W; ++i) {
    const int cell = arg.cell[first + i];
    mask[i] = cell >= 0 && arg.phase[cell] == kGone ? -1 : 0;
  }
  return mask;
}

/// What is drawn out far has large faces: pressure on them would drive it on.
TROCAR_INLINE V share_of(V ratio) {
  const V least = (ratio - kCrushed) / (kLeast - kCrushed), most = (kBurst - ratio) / (kBurst - kMost);
  return larger(smaller(smaller(least, most), all(1)), V{});
}

/// What cells have of volume for each corner, and how lightly that gives way: the sum of |dV/dx|^2 / m. One that is
/// gone counts as it was drawn: it neither presses nor is pressed.
TROCAR_INLINE void look_at_cells(const VolumeArgs& arg, int pack) {
  for (int part = 0; part < kSlice; part += W) {
    const CellsNow cell = cells_now(arg, pack, part);
    const I left_out = gone(arg, pack * kSlice + part);
    V answer{}, liveliest{};
    for (int i = 0; i < 4; ++i) {
      const V square = dot(cell.by[i], cell.by[i]);
      answer = answer + cell.w[i] * square;
      liveliest = larger(cell.w[i] * cell.w[i] * square, liveliest);
    }
    const V rest6 = load(arg.rest6 + pack * kSlice + part);
    const V share = where(~left_out, share_of(cell.volume6 / rest6)), speed = root(liveliest);
    __builtin_memcpy(arg.bounds[pack].share + part, &share, sizeof share);
    __builtin_memcpy(arg.bounds[pack].speed + part, &speed, sizeof speed);
    store_forces(arg.answers[1 + pack].slot[kSlotOfLane[part]],
                 {pick(left_out, rest6, cell.volume6) / 24.0f, where(~left_out, answer), V{}});
  }
}

/// What one cell gives its liveliest corner is bounded.
TROCAR_INLINE V bounded(V push, V answer) {
  const V speed = magnitude(push) * answer;
  return pick((I)(speed > all(kQuickest)), push * (kQuickest / speed), push);
}

TROCAR_INLINE void push_corners(const VolumeArgs& arg, int pack) {
  for (int part = 0; part < kSlice; part += W) {
    const CellsNow cell = cells_now(arg, pack, part);  // with their corners' pressures by now
    const V* const p = cell.w;
    const CellBounds& bounds = arg.bounds[pack];
    const V push = bounded(-(load(bounds.share + part) * ((p[0] + p[1]) + (p[2] + p[3]))) / 24.0f,
                           arg.dt * load(bounds.speed + part));
    for (int i = 0; i < 4; ++i) store_forces(arg.forces[1 + 4 * pack + i].slot[kSlotOfLane[part]], push * cell.by[i]);
  }
}

typedef float Q __attribute__((vector_size(16)));
TROCAR_INLINE Q load_quad(const void* p) {
  Q a;
  __builtin_memcpy(&a, p, sizeof a);
  return a;
}
constexpr int kAtOnce = W == 16 ? 16 : 8;  // rows of a slice whose sums are in registers

/// What the cells around rows have left for them. @param at(column)  where these rows find it
template <class At>
TROCAR_INLINE void pick_up(const VolumeArgs& arg, int slice, const ForcePack* left, At&& at, Q* sum) {
  const char* const from = reinterpret_cast<const char*>(left);
  for (int i = 0; i < kAtOnce; ++i) sum[i] = Q{};
  for (int c = arg.around_begin[slice]; c < arg.around_begin[slice + 1]; ++c) {
    const std::uint32_t* const offset = at(arg.around[c]);
    for (int i = 0; i < kAtOnce; ++i) sum[i] = sum[i] + load_quad(from + offset[i]);
  }
}

/// Pressures of rows, by their volumes [m^3] and answers [m^4/kg].
TROCAR_INLINE void press_rows(const VolumeArgs& arg, int row, V volume, V answer) {
  const V drawn = load(arg.drawn + row), kappa = load(arg.kappa + row), one = all(1), bound = all(arg.most_answer);
  const V gives = where((I)(drawn > V{}), answer / drawn);
  const V soft = pick((I)(gives > bound) & (I)(bound > V{}), bound / gives, one);
  const V pressure = where((I)(kappa > V{}), soft * kappa * (within(volume / drawn, kLeast, kMost) - one));
  __builtin_memcpy(arg.node_answer + row, &gives, sizeof gives);
  for (int i = 0; i < W; ++i) arg.places[row + i].w = pressure[i];
}

TROCAR_INLINE void settle_pressures(const VolumeArgs& arg, int slice) {
  float volume[kSlice], answer[kSlice];
  for (int first = 0; first < kSlice; first += kAtOnce) {
    Q sum[kAtOnce];
    pick_up(
        arg, slice, arg.answers, [first](const CellPack& c) { return c.answer + first; }, sum);
    for (int i = 0; i < kAtOnce; ++i) volume[first + i] = sum[i][0], answer[first + i] = sum[i][1];
  }
  for (int part = 0; part < kSlice; part += W)
    press_rows(arg, slice * kSlice + part, load(volume + part), load(answer + part));
}

TROCAR_INLINE void kick_rows(const VolumeArgs& arg, int slice) {
  for (int first = 0; first < kSlice; first += kAtOnce) {
    Q sum[kAtOnce];
    pick_up(
        arg, slice, arg.forces, [first](const CellPack& c) { return c.force + first; }, sum);
    for (int i = 0; i < kAtOnce; ++i) {
      const int row = slice * kSlice + first + i;
      const Q v = load_quad(&arg.nodes[row].vx) + arg.times * load_quad(arg.weight + row) * sum[i];
      __builtin_memcpy(&arg.nodes[row].vx, &v, sizeof v);
    }
  }
}

TROCAR_INLINE void set_out(const VolumeArgs& arg) {
  arg.answers[0] = arg.forces[0] = ForcePack{};
  for (int row = 0; row < arg.slices * kSlice; ++row) {
    const NodeState& n = arg.nodes[row];
    arg.places[row] = {n.x, n.y, n.z, arg.weight[row].w};
  }
}

/// A look at all cells, pressures of all rows, a push of all cells, all rows kicked: each as soon as what it needs is
/// there, which is little before, as cells lie in the order of their rows. So it is in the cache.
void run_press(const VolumeArgs& arg) noexcept {
  int settled = 0, pushed = 0, kicked = 0;
  set_out(arg);
  for (int looked = 0; looked < arg.packs; ++looked) {
    look_at_cells(arg, looked);
    for (; settled < arg.slices && arg.last_pack[settled] <= looked; ++settled) {
      settle_pressures(arg, settled);
      for (; pushed < arg.packs && arg.last_slice[pushed] <= settled; ++pushed) {
        push_corners(arg, pushed);
        for (; kicked < arg.slices && arg.last_pack[kicked] <= pushed; ++kicked) kick_rows(arg, kicked);
      }
    }
  }
}

}  // namespace
}  // namespace trocar::tissue
