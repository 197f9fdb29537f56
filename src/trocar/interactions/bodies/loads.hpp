// The forces that a tick's interactions put on bodies: gathered with a tag that says whose they are, handed to the
// tissue in the order that it wants, and their reactions handed back to the owner of the tag.
#pragma once

#include <cstdint>
#include <vector>

#include <trocar/core/fields.hpp>
#include <trocar/tissue/network/network.hpp>
#include <trocar/tissue/network/skin.hpp>
#include <trocar/tissue/strand/strand.hpp>

namespace trocar::interactions {

/// Who caused a load. Reactions are summed per owner.
enum class Owner : std::int32_t { body = 0, tool_contact = 1, tool_hold = 2, strand_end = 3, anchor = 4 };
struct Tag {
  Owner owner = Owner::body;
  std::int32_t index = 0;  ///< tool, or strand
  std::int32_t sub = 0;    ///< hold; contact: number in the instrument's book, 0 = none
};

/// Loads on a network. Capacity is reserved at compile; what does not fit is left out and `overflowed` says so.
struct NetworkLoads {
  std::vector<tissue::NodeLoad> gathered, sorted;
  std::vector<Tag> tag;
  std::vector<std::int32_t> point;   ///< of gathered[i]: loads with the same number are shares of one point's load
  std::vector<std::uint64_t> order;  ///< node << 32 | place in gathered, ascending
  std::vector<std::uint64_t> spare;  ///< as many, while they are ordered
  std::vector<Tag> owner;            ///< of sorted[i]; anchors and strand ends on one node are one load: nobody asks
  std::vector<Vec3f> reaction;       ///< of sorted[i]
  bool overflowed = false;

  void reserve(std::size_t capacity);
  void clear() noexcept;
  /// @param share  it is a share of the same point's load as the one before it
  void add(const tissue::NodeLoad& load, Tag t, bool share = false) noexcept;
  void sort() noexcept;
  void keep_order() noexcept;     ///< instead, for bodies that take points: `sorted` is what was gathered
  bool handled() const noexcept;  ///< an instrument touches or holds it

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("gathered", s.gathered), v("sorted", s.sorted), v("tag", s.tag), v("point", s.point), v("order", s.order),
        v("spare", s.spare), v("owner", s.owner), v("reaction", s.reaction), v("overflowed", s.overflowed);
  }

 private:
  void order_by_node() noexcept;
};

/// Loads on a strand.
struct StrandLoads {
  std::vector<tissue::StrandLoad> list;
  std::vector<Tag> tag;
  std::vector<Vec3d> reaction;
  bool overflowed = false;

  void reserve(std::size_t capacity);
  void clear() noexcept;
  void add(const tissue::StrandLoad& load, Tag t) noexcept;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("list", s.list), v("tag", s.tag), v("reaction", s.reaction), v("overflowed", s.overflowed);
  }
};

/// A node's speed as far as a load may count on it that resists changes of it for a whole tick. One that is faster than
/// anything that hands do to tissue leaps, to and fro from sub-step to sub-step; a load that held it to that speed
/// would carry it on by decimetres, whatever its springs ask for.
Vec3d counted_on(Vec3d velocity) noexcept;

/// A spring-like load on a skin vertex, spread over its nodes by W transposed: force k P (target - x) + f0 - d P v.
struct SkinLoad {
  Vec3d f0{0, 0, 0};
  double k = 0;
  Vec3d shift{0, 0, 0};  ///< target - x now [m]
  Vec3d dir{0, 0, 0};    ///< zero or unit
  double d = 0;
};
/// @param least  nodes with a smaller share are left out
void add_skin_load(const tissue::NodeView& nodes, const tissue::Skin& skin, int vertex, const SkinLoad& load, Tag tag,
                   NetworkLoads& loads, float least = 0.01f) noexcept;

}  // namespace trocar::interactions
