// Knot vectors of B-splines: what is valid, where a parameter lies, how often a knot is repeated, and the usual ones.
//
//   const Knots k = clamped_uniform(3, 8);          // cubic, 8 control points, domain 0 .. 1
//   const Knots ring = periodic_uniform(3, 12);     // closed: 12 control points, none of them repeated
//   if (const std::string fault = fault_in(k); !fault.empty()) ...
//   const int span = span_of(k, 0.25);              // values[span] <= 0.25 < values[span + 1]
//
// Open splines are clamped: their first and last degree + 1 knots are equal. Closed ones are periodic: their knots go
// on before and behind the domain by whole periods, and function i belongs to control point i modulo their number, so
// that every control point is there once and may carry a mass.
// [Piegl & Tiller 1997, The NURBS Book, chapter 2; PT97 here and in the neighbours]
#pragma once

#include <string>
#include <vector>

namespace trocar::geometry::nurbs {

inline constexpr int kHighestDegree = 9;

struct Knots {
  int degree = 3;  ///< 1 .. kHighestDegree
  bool periodic = false;
  /// Ascending; functions() + degree + 1 of them. Periodic: the domain's knots, and degree more on either side.
  std::vector<double> values;

  int functions() const noexcept { return static_cast<int>(values.size()) - degree - 1; }
  int points() const noexcept { return periodic ? functions() - degree : functions(); }  ///< control points
  double start() const noexcept { return values[degree]; }
  double end() const noexcept { return values[functions()]; }
  double extent() const noexcept { return end() - start(); }  ///< of the domain; periodic: the period
  /// The control point that belongs to a function.
  int point_of(int function) const noexcept { return function < points() ? function : function - points(); }
  friend bool operator==(const Knots&, const Knots&) = default;
};

/// What is wrong with them, in words with places and numbers; empty where nothing is.
std::string fault_in(const Knots& knots);
/// @throws std::invalid_argument: `who`, and what fault_in says
void require_valid(const Knots& knots, const char* who);

/// u brought into the domain: clamped, or by whole periods into [start, end).
double into_domain(const Knots& knots, double u) noexcept;
/// The span [values[s], values[s + 1]) of some length that holds u (in the domain; at its end the last span).
/// [PT97 A2.1]
int span_of(const Knots& knots, double u) noexcept;
/// How many knots of the domain equal u; a periodic one's start and end are one knot.
int multiplicity(const Knots& knots, double u) noexcept;

struct Knot {
  double value;
  int multiplicity;
};
/// The different knots of the domain, ends included; a periodic one's start stands for its end, too.
std::vector<Knot> distinct(const Knots& knots);
/// Where the spans that have a length begin, and where the last of them ends.
std::vector<double> breaks(const Knots& knots);
/// The parameters that go with the control points: means of `degree` neighbouring knots. Periodic ones may lie outside
/// the domain by up to half of what a function spans.
std::vector<double> greville(const Knots& knots);

/// Clamped, on 0 .. 1, spans of equal length. @param points at least degree + 1
Knots clamped_uniform(int degree, int points);
/// Clamped with these knots (ascending, repeated as wished) between start and end.
Knots clamped(int degree, double start, const std::vector<double>& inside, double end);
/// Periodic on 0 .. 1, spans of equal length. @param points at least degree + 1
Knots periodic_uniform(int degree, int points);
/// Periodic with one period's knots (ascending, the first at the domain's start; as many as control points).
Knots periodic(int degree, const std::vector<double>& round, double period);
/// One period's knots, from the start on: what `periodic` makes them from. Of clamped ones: all but the end's.
std::vector<double> round_of(const Knots& knots);

/// The same spans, moved and stretched to another domain.
Knots on_domain(const Knots& knots, double start, double end);

}  // namespace trocar::geometry::nurbs
