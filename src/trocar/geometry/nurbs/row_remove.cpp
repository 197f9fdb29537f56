#include <algorithm>

#include <trocar/geometry/nurbs/row.hpp>

namespace trocar::geometry::nurbs {
namespace {

// The window of control points that a knot's removal changes, and what they become.  [PT97 A5.8], one knot at a time
struct Window {
  int first = 0;              // control points first .. first + count(old) - 1 become `points`, one less
  std::vector<Vec4d> points;  // of the new row
  double misfit = 0.0;
};

// Undoes the insertion from both ends of the window; where the two meet they should agree.
Window undo_insertion(const Row& row, double u, int last_place, int repeats) {
  const Knots& k = row.knots;
  const auto point = [&row, n = k.points()](int i) { return row.points[row.knots.periodic ? ((i % n) + n) % n : i]; };
  const auto share = [&k, u](int i) { return (u - k.values[i]) / (k.values[i + k.degree + 1] - k.values[i]); };
  int i = last_place - k.degree, j = last_place - repeats;
  Window window{i, {}, 0.0};
  std::vector<Vec4d> front{point(i - 1)}, back{point(j + 1)};
  for (; i < j; ++i, --j) {
    const double a = share(i), b = share(j);
    front.push_back((1.0 / a) * (point(i) - (1.0 - a) * front.back()));
    back.push_back((1.0 / (1.0 - b)) * (point(j) - b * back.back()));
  }
  if (i == j) {
    window.misfit = distance(point(i), blend(front.back(), back.back(), share(i)));
  } else {  // the same point from both ends
    window.misfit = distance(front.back(), back.back());
    front.back() = blend(front.back(), back.back(), 0.5);
    back.pop_back();
  }
  window.points.assign(front.begin() + 1, front.end());
  if (back.size() > 1) window.points.insert(window.points.end(), back.rbegin(), back.rend() - 1);
  return window;
}

}  // namespace

std::optional<Removal> without_knot(const Row& row, double u) {
  const Knots& k = row.knots;
  u = snapped(k, u);
  const int repeats = multiplicity(k, u), p = k.degree, n = k.points();
  if (repeats == 0 || u == k.start() || u == k.end()) return {};
  if (k.periodic && n <= p + 1) return {};
  const int place = span_of(k, u);  // the last of its repeats
  const Window window = undo_insertion(row, u, place, repeats);

  Removal removal{{}, window.misfit};
  removal.row.knots = k;
  const int count = static_cast<int>(window.points.size()), m = k.periodic ? n - 1 : n;
  if (k.periodic) {
    std::vector<double> round = round_of(k);
    round.erase(round.begin() + (place - p));
    removal.row.knots = periodic(p, round, k.extent());
  } else {
    removal.row.knots.values.erase(removal.row.knots.values.begin() + place);
  }
  removal.row.points.resize(static_cast<std::size_t>(n - 1));
  // New functions in front of the window keep their numbers, those behind it have one less.
  const int first = k.periodic ? window.first : 0;
  for (int i = first; i < first + n - 1; ++i) {
    Vec4d& target = removal.row.points[k.periodic ? ((i % m) + m) % m : i];
    if (i < window.first)
      target = row.points[i];
    else if (i < window.first + count)
      target = window.points[i - window.first];
    else
      target = row.points[k.periodic ? (i + 1) % n : i + 1];
  }
  return removal;
}

}  // namespace trocar::geometry::nurbs
