// Stations along a gut: marks on its wall at even distances, by which a surgeon says how far along something is. Which
// one a place of the wall belongs to follows from the way along the skin in the drawn shape, not through space: loops
// lie against each other, and the neighbour's wall is nearer than the own gut's middle.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <trocar/sim/model/state.hpp>

namespace trocar::training {

class Stations {
 public:
  Stations() = default;
  /// @param marks    targets of discs on one organ, in their order along it
  /// @param spacing  from one to the next; the first is so far from the beginning [m]
  Stations(const sim::Model& model, std::span<const std::int32_t> marks, double spacing);

  BodyId body() const { return m_body; }
  int count() const { return m_count; }
  /// How far along a vertex of its skin is [m].
  double of_vertex(size_t vertex) const { return m_spacing * (m_station[vertex] + 1); }
  /// How far along the hand's jaws hold it [m]; -1: they hold none of it.
  double held_at(const sim::Model& model, const sim::State& state, size_t hand) const;
  /// The same as where what they hold begins and ends: far apart where they have taken two loops. Nothing: none of it.
  struct Span {
    double from = 0, to = 0;  ///< [m]
  };
  std::optional<Span> held_span(const sim::Model& model, const sim::State& state, size_t hand) const;

 private:
  /// How far along is what jaws hold of it? [m]
  double of_held(const interactions::Bodies& bodies, const interactions::Hold& hold) const;

  BodyId m_body;
  int m_count = 0;
  double m_spacing = 0;
  std::vector<std::int16_t> m_station;  ///< (skin vertices) the nearest along the skin
};

/// Why these marks are no stations, for people; empty: they are.
std::string no_stations(const sim::Model& model, std::span<const std::int32_t> marks);

}  // namespace trocar::training
