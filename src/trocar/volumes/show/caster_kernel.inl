// The rays of a tile, over eight lanes whose operations the including file defines: F floats, I integers, M masks.
// Rays are taken 4 x 2 pixels at a time. Cells without anything to see are left in one step, whose length is a whole
// number of steps, so that samples stay where they would be; a ray ends where 98 % of the light are stopped. [Levoy
// 1990, Efficient ray tracing of volume data; skipping by distances: Zuiderveld et al. 1992]

struct V {
  F x, y, z;
};
inline V along(V o, V d, F t) { return {o.x + t * d.x, o.y + t * d.y, o.z + t * d.z}; }
inline F dot3(V a, V b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline V same(const float (&v)[3]) { return {all(v[0]), all(v[1]), all(v[2])}; }

/// Where a ray is within the box and on the shown sides of the planes.
struct Span {
  F from, to;
};
inline void within_slab(Span& span, F o, F inverse, float low, float high) {
  const F a = (all(low) - o) * inverse, b = (all(high) - o) * inverse;
  span.from = greater_of(span.from, lesser_of(a, b));
  span.to = lesser_of(span.to, greater_of(a, b));
}
inline Span shown_part(const CastJob& job, V o, V d, V inverse) {
  Span span{all(0.0f), all(1e9f)};
  within_slab(span, o.x, inverse.x, job.low[0], job.high[0]);
  within_slab(span, o.y, inverse.y, job.low[1], job.high[1]);
  within_slab(span, o.z, inverse.z, job.low[2], job.high[2]);
  for (int p = 0; p < job.planes; ++p) {
    const float* n = job.plane[p];
    const F side = all(n[0]) * o.x + all(n[1]) * o.y + all(n[2]) * o.z - all(n[3]);
    const F rate = all(n[0]) * d.x + all(n[1]) * d.y + all(n[2]) * d.z;
    const M flat = less(absolute(rate), all(1e-12f));
    const F t = (all(0.0f) - side) / pick(flat, all(1.0f), rate);
    const F hidden = pick(less(side, all(0.0f)), all(1e9f), all(0.0f));  // of rays along the plane: all or nothing
    span.from = greater_of(span.from, pick(flat, hidden, pick(less(all(0.0f), rate), t, all(0.0f))));
    span.to = lesser_of(span.to, pick(flat, all(1e9f), pick(less(rate, all(0.0f)), t, all(1e9f))));
  }
  return span;
}

/// Eight corners around each place, as two values along x for each of four rows.
struct Corners {
  F low[4], high[4];
  V share;
};
inline Corners corners_at(const CastJob& job, V p) {
  Corners c;
  const F x = lesser_of(greater_of(p.x, all(0.0f)), all(float(job.size[0] - 1)));
  const F y = lesser_of(greater_of(p.y, all(0.0f)), all(float(job.size[1] - 1)));
  const F z = lesser_of(greater_of(p.z, all(0.0f)), all(float(job.size[2] - 1)));
  const I i = lesser_of(whole(x), all(job.size[0] - 2));
  const I j = lesser_of(whole(y), all(job.size[1] - 2));
  const I k = lesser_of(whole(z), all(job.size[2] - 2));
  c.share = {x - real(i), y - real(j), z - real(k)};
  const int row = job.size[0], slice = job.size[0] * job.size[1];
  const I base = i + all(row) * j + all(slice) * k;
  pair_at(job.voxels, base, c.low[0], c.high[0]);
  pair_at(job.voxels, base + all(row), c.low[1], c.high[1]);
  pair_at(job.voxels, base + all(slice), c.low[2], c.high[2]);
  pair_at(job.voxels, base + all(slice + row), c.low[3], c.high[3]);
  return c;
}
inline F between(F a, F b, F share) { return a + share * (b - a); }
inline F value_of(const Corners& c) {
  F row[4];
  for (int r = 0; r < 4; ++r) row[r] = between(c.low[r], c.high[r], c.share.x);
  return between(between(row[0], row[1], c.share.y), between(row[2], row[3], c.share.y), c.share.z);
}
/// The slope of what is between the corners [numbers / voxel].
inline V slope_of(const Corners& c) {
  F row[4], step[4];
  for (int r = 0; r < 4; ++r) {
    step[r] = c.high[r] - c.low[r];
    row[r] = c.low[r] + c.share.x * step[r];
  }
  const F low = between(row[0], row[1], c.share.y), high = between(row[2], row[3], c.share.y);
  return {between(between(step[0], step[1], c.share.y), between(step[2], step[3], c.share.y), c.share.z),
          between(row[1] - row[0], row[3] - row[2], c.share.z), high - low};
}
inline F value_at(const CastJob& job, V p) { return value_of(corners_at(job, p)); }
/// The same over two voxels: smooth from cell to cell.
inline V wide_slope(const CastJob& job, V p) {
  const F one = all(1.0f), half = all(0.5f);
  return {half * (value_at(job, {p.x + one, p.y, p.z}) - value_at(job, {p.x - one, p.y, p.z})),
          half * (value_at(job, {p.x, p.y + one, p.z}) - value_at(job, {p.x, p.y - one, p.z})),
          half * (value_at(job, {p.x, p.y, p.z + one}) - value_at(job, {p.x, p.y, p.z - one}))};
}

/// How bright a place is, with the light beside the eye: by the angle of the surface where there is one.
inline F brightness(const CastJob& job, V slope, V d_mm) {
  const V mm{slope.x * all(job.inverse_spacing[0]), slope.y * all(job.inverse_spacing[1]),
             slope.z * all(job.inverse_spacing[2])};
  const F steep = root(dot3(mm, mm));
  const F facing = absolute(dot3(mm, d_mm)) / greater_of(steep, all(1e-6f));
  const F two = facing * facing, four = two * two, sixteen = four * four * four * four;
  const F lit = all(0.2f) + all(0.75f) * facing + all(0.25f) * sixteen;
  const F surface = lesser_of(steep / all(job.shade_full), all(1.0f));
  return between(all(0.8f), lit, surface);
}

struct Light {
  F red, green, blue, left;  ///< left: the share that is not stopped yet
};

/// A sample's colour in front of what is behind.
inline void add_sample(const CastJob& job, V p, V d_mm, M here, Light& light) {
  const Corners corners = corners_at(job, p);
  const F at = (value_of(corners) - all(job.table_from)) * all(job.table_scale);
  const I entry = whole(lesser_of(greater_of(at, all(0.0f)), all(float(kTableSize - 1))));
  const I four = entry + entry + entry + entry;
  F opacity = pick(here, entry_of(job.table + 3, four), all(0.0f));
  if (!any(less(all(1e-4f), opacity))) return;
  F red = entry_of(job.table, four), green = entry_of(job.table + 1, four), blue = entry_of(job.table + 2, four);
  if (job.tints) {
    const auto nearest = [](F v, int size) {
      return lesser_of(whole(greater_of(v, all(0.0f)) + all(0.5f)), all(size - 1));
    };
    const I voxel = nearest(p.x, job.size[0]) +
                    all(job.size[0]) * (nearest(p.y, job.size[1]) + all(job.size[1]) * nearest(p.z, job.size[2]));
    const I tint = byte_at(job.tints, voxel);
    const I row = tint + tint + tint + tint;
    const F much = entry_of(job.tint_table + 3, row);
    red = between(red, entry_of(job.tint_table, row), much);
    green = between(green, entry_of(job.tint_table + 1, row), much);
    blue = between(blue, entry_of(job.tint_table + 2, row), much);
    opacity = opacity * entry_of(job.tint_opacity, tint);
  }
  V slope = slope_of(corners);
  if (job.fine_gradient && any(less(all(0.02f), opacity * light.left))) slope = wide_slope(job, p);
  const F weight = opacity * light.left;
  const F bright = weight * brightness(job, slope, d_mm);
  light.red = light.red + bright * red;
  light.green = light.green + bright * green;
  light.blue = light.blue + bright * blue;
  light.left = light.left - weight;
}

/// From here to where the empty cells around end [mm along the ray].
inline F way_out(V p, V d, V inverse, I cx, I cy, I cz, I empty) {
  const auto exit = [&](F at, F direction, F inverted, I cell) {
    const I ahead = cell + empty, behind = cell - empty + all(1);
    const M up = less(all(0.0f), direction);
    const F bound = all(float(kCellEdge)) * pick(up, real(ahead), real(behind));
    return (bound - at) * inverted;
  };
  return lesser_of(exit(p.x, d.x, inverse.x, cx),
                   lesser_of(exit(p.y, d.y, inverse.y, cy), exit(p.z, d.z, inverse.z, cz)));
}

/// A number 0 .. 1 for a pixel: rays that all begin at the same depth show rings.
inline F scatter(I x, I y) {
  I h = x * all(0x2545F491) + y * all(0x5bd1e995) + all(0x1b873593);
  for (int round = 0; round < 3; ++round)
    h = h * h + h * all(0x27d4eb2d) + bits_of(h, 15, 0x1ffff);  // squares leave no pattern
  return real(bits_of(h, 8, 0xffff)) * all(1.0f / 65536.0f);
}

inline void write_pixels(const CastJob& job, int x0, int y0, int x1, int y1, const Light& light, F depth) {
  const auto byte = [](F v) { return whole(lesser_of(greater_of(v, all(0.0f)), all(1.0f)) * all(255.0f) + all(0.5f)); };
  const F opacity = all(1.0f) - light.left;
  std::int32_t r[8], g[8], b[8], a[8];
  float d[8];
  store(r, byte(lesser_of(light.red, opacity)));
  store(g, byte(lesser_of(light.green, opacity)));
  store(b, byte(lesser_of(light.blue, opacity)));
  store(a, byte(opacity));
  store(d, depth);
  for (int lane = 0; lane < 8; ++lane) {
    const int x = x0 + lane % 4, y = y0 + lane / 4;
    if (x >= x1 || y >= y1) continue;
    const std::size_t at = std::size_t(y) * std::size_t(job.width) + std::size_t(x);
    job.pixels[at] = std::uint32_t(r[lane]) | std::uint32_t(g[lane]) << 8 | std::uint32_t(b[lane]) << 16 |
                     std::uint32_t(a[lane]) << 24;
    job.depth[at] = d[lane];
  }
}

inline void cast_eight(const CastJob& job, int x0, int y0, int x1, int y1) {
  const I px = all(x0) + lane_x(), py = all(y0) + lane_y();
  const F sx = real(px) - all(0.5f * float(job.width - 1)), sy = real(py) - all(0.5f * float(job.height - 1));
  V o = same(job.origin), d = same(job.forward), d_mm = same(job.metric_forward);
  const V right = same(job.right), down = same(job.down);
  if (job.perspective) {
    const V metric_right = same(job.metric_right), metric_down = same(job.metric_down);
    d = along(along(d, right, sx), down, sy);
    d_mm = along(along(d_mm, metric_right, sx), metric_down, sy);
    const F shorter = all(1.0f) / root(dot3(d_mm, d_mm));
    d = {d.x * shorter, d.y * shorter, d.z * shorter};
    d_mm = {d_mm.x * shorter, d_mm.y * shorter, d_mm.z * shorter};
  } else {
    o = along(along(o, right, sx), down, sy);
  }
  const auto inverted = [](F v) {
    const F tiny = all(1e-12f);
    return all(1.0f) / pick(less(absolute(v), tiny), tiny, v);
  };
  const V inverse{inverted(d.x), inverted(d.y), inverted(d.z)};
  const Span span = shown_part(job, o, d, inverse);
  const F step = all(job.step);
  F t = span.from + scatter(px, py) * step;
  Light light{all(0.0f), all(0.0f), all(0.0f), all(1.0f)};
  F depth = all(1e30f);
  M alive = less(t, span.to);
  while (any(alive)) {
    const V p = along(o, d, t);
    const I cx = cell_of(p.x, job.cells[0]), cy = cell_of(p.y, job.cells[1]), cz = cell_of(p.z, job.cells[2]);
    const I empty = byte_at(job.skip, cx + all(job.cells[0]) * (cy + all(job.cells[1]) * cz));
    const M occupied = is_zero(empty);
    const M here = both(occupied, alive);
    if (any(here)) {
      add_sample(job, p, d_mm, here, light);
      depth = pick(both(here, less(light.left, all(0.5f))), lesser_of(depth, t), depth);
    }
    const F out = way_out(p, d, inverse, cx, cy, cz, empty);
    const F steps = real(whole(lesser_of(greater_of(out, all(0.0f)) / step, all(1e6f)))) + all(1.0f);
    t = t + step * pick(occupied, all(1.0f), steps);
    alive = both(less(t, span.to), less(all(0.02f), light.left));
  }
  // What is left of nearly opaque rays is not worth a hole in the picture.
  light.left = pick(less(light.left, all(0.02f)), all(0.0f), light.left);
  write_pixels(job, x0, y0, x1, y1, light, depth);
}

inline void cast_tile(const CastJob& job, int x0, int y0, int x1, int y1) noexcept {
  for (int y = y0; y < y1; y += 2)
    for (int x = x0; x < x1; x += 4) cast_eight(job, x, y, x1, y1);
}
