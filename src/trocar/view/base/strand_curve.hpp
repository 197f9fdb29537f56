// The smooth line through a strand's nodes, in pieces where it is cut: what tubes and folds are swept along.
//   const StrandCurve curve(body, state, pieces_of(...));
//   const CurveFrame at = curve.at(0, s);          // piece 0, arc length s [m]
// Cubic between nodes with their central differences as slopes [Catmull & Rom 74]; a piece's stump continues straight.
#pragma once

#include <span>
#include <vector>

#include <trocar/interactions/bodies/strand_body.hpp>

namespace trocar::view {

/// Nodes that still hang together, and how far the tissue reaches beyond them into cut elements.
struct StrandPiece {
  int first = 0, last = 0;  ///< nodes
  double from = 0, to = 0;  ///< arc length [m]
  bool cut_start = false, cut_end = false;

  friend bool operator==(const StrandPiece&, const StrandPiece&) = default;
};

/// @param cuts all cuts; those of `strand` say where within its element each one went through
std::vector<StrandPiece> pieces_of(const interactions::StrandBody& body, std::span<const std::uint8_t> alive,
                                   std::span<const interactions::Cut> cuts, int strand);

struct CurveFrame {
  Vec3d point, tangent, normal, binormal;
};

class StrandCurve {
 public:
  /// Refers to what it is given.
  StrandCurve(const interactions::StrandBody& body, const tissue::StrandState& state,
              std::span<const StrandPiece> pieces);

  CurveFrame at(int piece, double s) const;
  std::span<const StrandPiece> pieces() const { return m_pieces; }

 private:
  Vec3d slope(const StrandPiece& piece, int node) const;
  Vec3d normal_at(const StrandPiece& piece, interactions::StrandPlace place) const;

  const interactions::StrandBody* m_body;
  const tissue::StrandState* m_state;
  std::span<const StrandPiece> m_pieces;
  std::vector<interactions::StrandFrame> m_frames;  ///< (elements)
};

}  // namespace trocar::view
