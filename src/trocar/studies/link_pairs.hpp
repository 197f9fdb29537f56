// Which links of a mechanism may meet, and how far they are apart in a pose.
//
// Links that joints without freedom keep together are one part. Parts that a joint or a closure connects are
// neighbours: they touch at the joint, and shapes are drawn there in each other. Of them counts what is new: a rod is
// looked at from twice the shapes' thickness off the joint on, and shapes that are in each other as drawn count from
// that depth on.
//
//   const LinkPairs pairs(m, {});
//   const std::vector<double> drawn = pairs.drawn(m, pose);   // of the pose as described
//   pairs.gap(pairs.all()[0], m, pose, drawn);
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include <trocar/kinematics/chains/mechanism.hpp>

namespace trocar::studies {

/// Where two parts are joined.
struct PartJoint {
  int body = 0;         ///< that the joint moves: its frame's origin lies on it
  bool axis = false;    ///< a hinge: all of its axis is the joint
  bool slides = false;  ///< no place of it is
  int closure = -1;     ///< or a closure: where its second frame is, which slides on the first
};

/// Two links with shapes that may meet.
struct LinkPair {
  int first = 0, second = 0;                ///< into Mechanism::links
  std::vector<std::pair<int, int>> shapes;  ///< into Mechanism::shapes
  std::vector<PartJoint> joints;            ///< of neighbours
  int drawn = 0;                            ///< of neighbours: number of their first shapes' gap as drawn
  bool neighbours() const noexcept { return !joints.empty(); }
};

class LinkPairs {
 public:
  /// @param ignored  pairs of links
  LinkPairs(const kinematics::Mechanism& m, std::span<const std::pair<int, int>> ignored);

  const std::vector<LinkPair>& all() const noexcept { return m_pairs; }
  /// Gaps of neighbours' shapes off their joints, in a pose that counts as drawn [m]; far apart: infinite.
  std::vector<double> drawn(const kinematics::Mechanism& m, const kinematics::Pose& pose) const;
  /// How far two links are apart, below 0: in each other. Neighbours: below 0 by how much deeper than drawn. [m]
  double gap(const LinkPair& pair, const kinematics::Mechanism& m, const kinematics::Pose& pose,
             std::span<const double> drawn) const noexcept;
  /// How deep neighbours may be without being in each other: shapes are drawn with a few faces and radii [m].
  double slack(const LinkPair& pair, const kinematics::Mechanism& m) const noexcept;
  /// The pair of these links, or null.
  const LinkPair* of(int first, int second) const noexcept;

 private:
  std::vector<LinkPair> m_pairs;
  int m_drawn = 0;
};

}  // namespace trocar::studies
