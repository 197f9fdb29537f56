#include <algorithm>

#include <trocar/core/parallel.hpp>
#include <trocar/volumes/show/caster_kernel.hpp>
#include <trocar/volumes/show/cells.hpp>

namespace trocar::volumes {

CellRanges cell_ranges(const Volume& volume, core::ThreadPool& pool) {
  CellRanges out;
  for (std::size_t k = 0; k < 3; ++k) out.cells[k] = (volume.grid.size[k] + kCellEdge - 1) / kCellEdge;
  const std::size_t nx = std::size_t(out.cells[0]), ny = std::size_t(out.cells[1]), nz = std::size_t(out.cells[2]);
  out.range.assign(nx * ny * nz, {std::int16_t(32767), std::int16_t(-32768)});
  core::run(pool, out.cells[2], [&](int cz) noexcept {
    for (int cy = 0; cy < out.cells[1]; ++cy)
      for (int cx = 0; cx < out.cells[0]; ++cx) {
        // Between voxels 7 and 8 the values of both count.
        const Index3 low{cx * kCellEdge, cy * kCellEdge, cz * kCellEdge};
        Index3 high{};
        for (std::size_t k = 0; k < 3; ++k) high[k] = std::min(low[k] + kCellEdge + 1, volume.grid.size[k]);
        auto& range = out.range[std::size_t(cx) + nx * (std::size_t(cy) + ny * std::size_t(cz))];
        for (int k = low[2]; k < high[2]; ++k)
          for (int j = low[1]; j < high[1]; ++j) {
            const std::int16_t* row = volume.stored.data() + volume.grid.index(low[0], j, k);
            for (int i = 0; i < high[0] - low[0]; ++i) {
              range.first = std::min(range.first, row[i]);
              range.second = std::max(range.second, row[i]);
            }
          }
      }
  });
  return out;
}

std::vector<std::uint8_t> empty_around(const CellRanges& ranges, const std::vector<std::uint32_t>& visible_up_to) {
  std::vector<std::uint8_t> out(ranges.count() + 3);
  for (std::size_t c = 0; c < ranges.count(); ++c) {
    const auto& [least, greatest] = ranges.range[c];
    out[c] = visible_up_to[std::size_t(greatest + 32769)] > visible_up_to[std::size_t(least + 32768)] ? 0 : 255;
  }
  // The distance of kings on a chess board, exactly, in a sweep forwards and one backwards.
  const int nx = ranges.cells[0], ny = ranges.cells[1], nz = ranges.cells[2];
  const auto sweep = [&](int from, int step) {
    for (int kk = 0; kk < nz; ++kk)
      for (int jj = 0; jj < ny; ++jj)
        for (int ii = 0; ii < nx; ++ii) {
          const int i = from == 0 ? ii : nx - 1 - ii, j = from == 0 ? jj : ny - 1 - jj,
                    k = from == 0 ? kk : nz - 1 - kk;
          std::uint8_t& here = out[std::size_t(i + nx * (j + ny * k))];
          for (int n = 0; n < 13; ++n) {  // the half of the 26 neighbours that come before
            const int dk = n < 9 ? -step : 0,
                      dj = n < 9    ? n / 3 - 1
                           : n < 12 ? -step
                                    : 0,
                      di = n < 12 ? n % 3 - 1 : -step;
            const int x = i + di, y = j + dj, z = k + dk;
            if (x < 0 || y < 0 || z < 0 || x >= nx || y >= ny || z >= nz) continue;
            const int reached = out[std::size_t(x + nx * (y + ny * z))] + 1;
            if (reached < here) here = std::uint8_t(reached);
          }
        }
  };
  sweep(0, 1);
  sweep(1, -1);
  return out;
}

}  // namespace trocar::volumes
