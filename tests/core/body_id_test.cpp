#include <cstring>
#include <string>

#include <gtest/gtest.h>

#include <trocar/core/body_id.hpp>

namespace trocar {
namespace {

TEST(BodyId, KeepsKindAndIndexInFourBytes) {
  for (const BodyKindName& k : kBodyKinds)
    for (const std::size_t i : {0u, 1u, 65535u}) {
      const BodyId id(k.kind, i);
      EXPECT_EQ(id.kind(), k.kind);
      EXPECT_EQ(id.index(), i);
      EXPECT_TRUE(id.exists());
      EXPECT_EQ(BodyId::of_code(id.code()), id);
    }
}

TEST(BodyId, NoneAndWallsAreNoBodies) {
  EXPECT_FALSE(BodyId().exists());
  EXPECT_FALSE(BodyId::wall().exists());
  EXPECT_TRUE(BodyId().is(BodyKind::none));
  EXPECT_TRUE(BodyId::wall().is(BodyKind::wall));
  EXPECT_NE(BodyId(), BodyId::wall());
  EXPECT_FALSE(BodyId::maybe(BodyKind::organ, -1).exists());
  EXPECT_EQ(BodyId::maybe(BodyKind::organ, 3), BodyId::organ(3));
}

TEST(BodyId, IsWhatStatesAndRecordingsHaveInTheirBytes) {
  EXPECT_EQ(BodyId().code(), -1);
  EXPECT_EQ(BodyId::wall().code(), -2);
  EXPECT_EQ(BodyId::strand(5).code(), 5);
  EXPECT_EQ(BodyId::organ(2).code(), (1 << 16) + 2);
  EXPECT_EQ(BodyId::membrane(7).code(), (1 << 17) + 7);
  const BodyId id = BodyId::organ(2);
  std::int32_t bytes = 0;
  std::memcpy(&bytes, &id, sizeof id);
  EXPECT_EQ(bytes, id.code());
}

TEST(BodyId, KindsComeInTheirOrderAndHaveNamesOfTheirOwn) {
  for (std::size_t i = 0; i < std::size(kBodyKinds); ++i) {
    EXPECT_EQ(std::size_t(kBodyKinds[i].kind), i);
    for (std::size_t k = 0; k < i; ++k) EXPECT_NE(std::string(kBodyKinds[i].name), kBodyKinds[k].name);
  }
  EXPECT_LT(BodyId::strand(9), BodyId::organ(0));
  EXPECT_LT(BodyId::organ(9), BodyId::membrane(0));
}

}  // namespace
}  // namespace trocar
