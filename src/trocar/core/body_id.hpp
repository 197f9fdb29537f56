// Which body of a scene something is about: what kind of body, and its number among those. What hands hold, touch, cut
// and heat is named so, in the State and in recordings. Which operations a kind has is in sim/bodies.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace trocar {

/// The kinds of bodies that hands meet. A new kind is one line here and one in kBodyKinds.
enum class BodyKind : std::int16_t {
  wall = -2,  ///< only that it is a wall: walls have no numbers
  none = -1,
  strand = 0,
  organ = 1,
  membrane = 2,
  rigid = 3,
  fat = 4,
  bag = 5,
  suture = 6,
};

struct BodyKindName {
  BodyKind kind;
  const char *name, *plural, *what;
};
inline constexpr BodyKindName kBodyKinds[] = {
    {BodyKind::strand, "strand", "strands", "a tube or a ligament: a chain of elements"},
    {BodyKind::organ, "organ", "organs", "a volume with a skin: a lattice, or tetrahedra that can be cut"},
    {BodyKind::membrane, "membrane", "membranes", "a membrane (fold), or the wall of a closed membrane (pouch)"},
    {BodyKind::rigid, "rigid object", "rigid objects", "a rigid object, not tissue"},
    {BodyKind::fat, "fat", "bodies of fat", "lobules of fat between ducts and vessels, which can be separated"},
    {BodyKind::bag, "bag", "bags", "a retrieval bag: cloth on a hoop"},
    {BodyKind::suture, "suture", "sutures", "a needle with a thread, or either alone"},
};

/// A body by its kind and its number among its kind. Four bytes; their order is by kind, then number.
class BodyId {
 public:
  constexpr BodyId() noexcept = default;  ///< none
  constexpr BodyId(BodyKind kind, std::size_t index) noexcept
      : m_code(kind < BodyKind::strand ? std::int32_t(kind) : std::int32_t(kind) * kEach + std::int32_t(index)) {}

  static constexpr BodyId strand(std::size_t i) noexcept { return {BodyKind::strand, i}; }
  static constexpr BodyId organ(std::size_t i) noexcept { return {BodyKind::organ, i}; }
  static constexpr BodyId membrane(std::size_t i) noexcept { return {BodyKind::membrane, i}; }
  static constexpr BodyId wall() noexcept { return {BodyKind::wall, 0}; }
  /// Of an index that is below 0 where there is none.
  static constexpr BodyId maybe(BodyKind kind, std::int32_t index) noexcept {
    return index < 0 ? BodyId{} : BodyId{kind, std::size_t(index)};
  }

  constexpr BodyKind kind() const noexcept { return BodyKind(m_code < 0 ? m_code : m_code / kEach); }
  constexpr std::size_t index() const noexcept { return m_code < 0 ? 0 : std::size_t(m_code % kEach); }
  constexpr bool is(BodyKind k) const noexcept { return kind() == k; }
  constexpr bool exists() const noexcept { return m_code >= 0; }  ///< neither none nor a wall

  /// As it stands in a State, a recording or an event: -1 none, -2 a wall.
  constexpr std::int32_t code() const noexcept { return m_code; }
  static constexpr BodyId of_code(std::int32_t code) noexcept {
    BodyId id;
    id.m_code = code;
    return id;
  }

  friend constexpr bool operator==(BodyId a, BodyId b) noexcept { return a.m_code == b.m_code; }
  friend constexpr bool operator!=(BodyId a, BodyId b) noexcept { return a.m_code != b.m_code; }
  friend constexpr bool operator<(BodyId a, BodyId b) noexcept { return a.m_code < b.m_code; }

 private:
  static constexpr std::int32_t kEach = 1 << 16;  // bodies of a kind, at most
  std::int32_t m_code = -1;
};
static_assert(sizeof(BodyId) == 4 && std::is_trivially_copyable_v<BodyId>, "no padding");

}  // namespace trocar
