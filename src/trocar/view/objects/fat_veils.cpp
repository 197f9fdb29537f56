#include <algorithm>

#include <trocar/view/objects/fat_veils.hpp>

namespace trocar::view {
namespace {

constexpr float kParted = 1.6f, kFarthest = 4.6f;  // spacings between what a film closes the notch of
constexpr float kClear = 0.75f;                    // spacings: nothing may lie so near to the middle of its free border
constexpr float kStacked = 0.7f;                   // spacings: films no further apart are one
constexpr std::size_t kInside = 11;                // links: what has so many lies within fat
constexpr int kEachAtMost = 2;                     // films that begin at a place
constexpr std::size_t kMostVeils = 240;
constexpr int kMostLinks = 7;                   // of the way round
constexpr int kVeilAlong = 8, kVeilAcross = 4;  // vertices
constexpr float kDrawnIn = 0.25f;               // of the way to the other side, how far its free border is drawn in

using Near = std::vector<std::vector<int>>;

Near linked(const VeilFrame& frame) {
  Near to(frame.places.size());
  for (const auto& [a, b] : frame.links) to[std::size_t(a)].push_back(b), to[std::size_t(b)].push_back(a);
  return to;
}

/// Others within `reach` of each place.
Near around(const VeilFrame& frame, float reach) {
  Near near(frame.places.size());
  for (std::size_t i = 0; i < near.size(); ++i)
    for (std::size_t j = i + 1; j < near.size(); ++j) {
      const Vec3f off = frame.places[i] - frame.places[j];
      if (dot(off, off) < reach * reach) near[i].push_back(int(j)), near[j].push_back(int(i));
    }
  return near;
}

bool clear(const VeilFrame& frame, const std::vector<int>& near, Vec3f middle, float reach) {
  return std::none_of(near.begin(), near.end(), [&](int k) {
    const Vec3f off = frame.places[std::size_t(k)] - middle;
    return dot(off, off) < reach * reach;
  });
}

bool at_surface(const Near& to, int place) {
  const std::size_t links = to[std::size_t(place)].size();
  return links > 0 && links < kInside;
}

/// Where each place is reached from on the shortest way from `start`, by at most kMostLinks links; -1: not at all.
std::vector<int> ways_from(const Near& to, int start) {
  std::vector<int> from(to.size(), -1), reached{start};
  from[std::size_t(start)] = start;
  std::size_t next = 0;
  for (int links = 0; links < kMostLinks; ++links)
    for (const std::size_t end = reached.size(); next < end; ++next)
      for (const int k : to[std::size_t(reached[next])])
        if (from[std::size_t(k)] < 0) from[std::size_t(k)] = reached[next], reached.push_back(k);
  return from;
}

FatVeil way(const std::vector<int>& from, int end) {
  FatVeil veil{end};
  while (from[std::size_t(veil.back())] != veil.back()) veil.push_back(from[std::size_t(veil.back())]);
  std::reverse(veil.begin(), veil.end());
  return veil;
}

/// What a notch could be closed to from `a`: beyond it, nothing in between, farthest first.
std::vector<int> across_notches(const VeilFrame& frame, const Near& to, const std::vector<int>& near, int a,
                                float spacing) {
  const Vec3f from = frame.places[std::size_t(a)];
  const auto way_to = [&](int b) { return frame.places[std::size_t(b)] - from; };
  std::vector<int> found;
  for (const int b : near)
    if (b > a && at_surface(to, b) && length(way_to(b)) > kParted * spacing &&
        clear(frame, near, from + 0.5f * way_to(b), kClear * spacing))
      found.push_back(b);
  std::sort(found.begin(), found.end(), [&](int b, int c) { return length(way_to(b)) > length(way_to(c)); });
  return found;
}

}  // namespace

std::vector<FatVeil> fat_veils(const VeilFrame& frame, float spacing) {
  const Near to = linked(frame), near = around(frame, kFarthest * spacing);
  std::vector<FatVeil> veils;
  std::vector<Vec3f> middles;
  for (int a = 0; a < int(to.size()); ++a) {
    if (!at_surface(to, a)) continue;
    const std::vector<int> across = across_notches(frame, to, near[std::size_t(a)], a, spacing);
    if (across.empty()) continue;
    const std::vector<int> from = ways_from(to, a);
    int begun = 0;
    for (const int b : across) {
      if (begun == kEachAtMost || veils.size() == kMostVeils) break;
      if (from[std::size_t(b)] < 0 || from[std::size_t(b)] == a) continue;
      const Vec3f middle = 0.5f * (frame.places[std::size_t(a)] + frame.places[std::size_t(b)]);
      if (std::any_of(middles.begin(), middles.end(),
                      [&](Vec3f other) { return length(other - middle) < kStacked * spacing; }))
        continue;
      middles.push_back(middle);
      veils.push_back(way(from, b));
      ++begun;
    }
  }
  return veils;
}

void add_veil(const VeilFrame& frame, const FatVeil& veil, float spacing, MeshBuffer& to) {
  const std::uint32_t first = to.size();
  const auto at = [&](const std::vector<Vec3f>& of, float u, float v) {
    const float x = u * float(veil.size() - 1);
    const std::size_t k = std::min(std::size_t(x), veil.size() - 2);
    const auto place = [&](std::size_t n) { return of[std::size_t(veil[n])]; };
    const Vec3f border = (1 - u) * place(0) + u * place(veil.size() - 1);
    const Vec3f back = place(k) + (x - float(k)) * (place(k + 1) - place(k));
    const float hollow = kDrawnIn * 4 * u * (1 - u) * (1 - v);
    return border + (v + hollow * (1 - v)) * (back - border);
  };
  const double apart =
      length(frame.places[std::size_t(veil.front())] - frame.places[std::size_t(veil.back())]) / spacing;
  // It comes and goes by and by, as lobules are drawn apart.
  const double there = smooth(kParted, kParted + 0.5, apart) * smooth(kFarthest, kFarthest - 0.6, apart);
  for (int r = 0; r < kVeilAcross; ++r)
    for (int c = 0; c < kVeilAlong; ++c) {
      const float u = float(c) / (kVeilAlong - 1), v = float(r) / (kVeilAcross - 1);
      const double lacy = there * (0.6 + 0.4 * varied(veil.front() * 31 + veil.back(), 10 + r * kVeilAlong + c));
      to.add(at(frame.places, u, v), {to_byte((r == 0 ? 0.1 : 0.85) * lacy), 0, 0, to_byte(r == 1 ? 0.25 * lacy : 0)});
      to.rest.push_back(at(frame.rest, u, v));
    }
  for (std::uint32_t r = 0; r + 1 < kVeilAcross; ++r)
    join_rows(to, first + r * kVeilAlong, first + (r + 1) * kVeilAlong, kVeilAlong, false);
}

}  // namespace trocar::view
