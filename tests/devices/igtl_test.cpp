// What a tracker says: known messages, in pieces, damaged, and of other kinds. The bytes of the known ones were packed
// by the OpenIGTLink library, 1.11.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <trocar/devices/tracker/igtl.hpp>

namespace trocar::devices {
namespace {

using Octets = std::vector<std::uint8_t>;

Octets bytes_of(const std::string& hex) {
  Octets out;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
    out.push_back(std::uint8_t(std::stoi(hex.substr(i, 2), nullptr, 16)));
  return out;
}

// A turn by 0.5 rad about z, at (12.5, -3, 100.25) mm.
const std::string kTransform =
    "00015452414e53464f524d0000004772617370657200000000000000000000000000000004d27fffffff00000000000000308823e5072181ad"
    "f8"
    "3f60a9403ef5774400000000bef577443f60a9400000000000000000000000003f80000041480000c040000042c88000";
const std::string kPosition =
    "0001504f534954494f4e0000000047726173706572000000000000000000000000000000000000000000000000000000001c221bce97672ea4"
    "a3"
    "3f800000400000004040000000000000000000003e7d57773f780aa5";
const std::string kTools =
    "0001544441544100000000000000547261636b6572000000000000000000000000000000000000000000000000000000008c459e4164b0f4e2"
    "6a"
    "477261737065720000000000000000000000000002003f60a9403ef5774400000000bef577443f60a9400000000000000000000000003f8000"
    "00"
    "41480000c040000042c8800053636f706500000000000000000000000000000002003f60a9403ef5774400000000bef577443f60a940000000"
    "00"
    "00000000000000003f80000041580000c040000042c88000";
const std::string kSensor =
    "000153454e534f5200000000000047726970730000000000000000000000000000000000000000000000000000000000001a771b8790ba2131"
    "78"
    "020000000000000000003fd00000000000003fe8000000000000";
const std::string kStatus =
    "0001535441545553000000000000547261636b6572000000000000000000000000000000000000000000000000000000002393bf4f809dbad6"
    "3f"
    "000100000000000000000a0000000000000000000000000000000000000066696e6500";

struct Listener {
  IgtlReader reader;
  std::vector<TrackedPose> poses;
  std::vector<SensorValues> values;
  bool hear(const Octets& bytes) {
    return reader.hear(
        bytes, [this](const TrackedPose& p) { poses.push_back(p); },
        [this](const SensorValues& v) { values.push_back(v); });
  }
};

TEST(Igtl, ItsChecksumIsThatOfEcma182) {
  const std::string check = "123456789";
  EXPECT_EQ(igtl_crc({reinterpret_cast<const std::uint8_t*>(check.data()), check.size()}), 0x6c40df5f0b497347ull);
}

TEST(Igtl, MessagesThatItsLibraryPackedAreReadAsWhatWasPacked) {
  Listener listener;
  for (const std::string& hex : {kTransform, kPosition, kTools, kSensor, kStatus})
    ASSERT_TRUE(listener.hear(bytes_of(hex)));
  ASSERT_EQ(listener.poses.size(), 4u);
  const TrackedPose& first = listener.poses[0];
  EXPECT_EQ(first.name, "Grasper");
  EXPECT_NEAR(length(first.place - Vec3d{0.0125, -0.003, 0.10025}), 0, 1e-9);
  EXPECT_NEAR(first.turned.m[1][0], std::sin(0.5), 1e-6);
  EXPECT_NEAR(first.turned.m[0][0], std::cos(0.5), 1e-6);
  EXPECT_NEAR(length(listener.poses[1].place - Vec3d{0.001, 0.002, 0.003}), 0, 1e-9);
  EXPECT_NEAR(listener.poses[1].turned.m[1][0], std::sin(0.5), 1e-6) << "the same turn as a quaternion";
  EXPECT_EQ(listener.poses[3].name, "Scope");
  EXPECT_NEAR(listener.poses[3].place.x, 0.0135, 1e-9);
  ASSERT_EQ(listener.values.size(), 1u);
  EXPECT_EQ(listener.values[0].values, (std::vector<double>{0.25, 0.75}));
  EXPECT_EQ(listener.reader.damaged(), 0u);
}

TEST(Igtl, WhatIsWrittenIsWhatTheLibraryWrites) {
  TrackedPose pose{"Grasper", {0.0125, -0.003, 0.10025}, Mat3d::identity()};
  pose.turned = Mat3d::from_columns({std::cos(0.5), std::sin(0.5), 0}, {-std::sin(0.5), std::cos(0.5), 0}, {0, 0, 1});
  Octets expected = bytes_of(kTransform);
  std::fill(expected.begin() + 34, expected.begin() + 42, std::uint8_t(0));  // no time stamp
  EXPECT_EQ(igtl_transform(pose), expected);
  EXPECT_EQ(igtl_sensor({"Grips", {0.25, 0.75}}), bytes_of(kSensor));
}

TEST(Igtl, AMessageThatComesByteByByteIsOne) {
  Listener listener;
  for (const std::uint8_t b : bytes_of(kStatus + kTransform)) ASSERT_TRUE(listener.hear({b}));
  EXPECT_EQ(listener.poses.size(), 1u);
}

TEST(Igtl, AnExtendedHeaderAndATableOfTextsAroundAPoseArePassedOver) {
  Octets v1 = bytes_of(kTransform);
  Octets body = bytes_of(
      "000c000600000004"
      "00000007");  // 12 bytes; 6 and 4 bytes after the pose; number 7
  body.insert(body.end(), v1.begin() + 58, v1.end());
  body.insert(body.end(), 10, std::uint8_t('x'));
  Octets v3(v1.begin(), v1.begin() + 58);
  v3[1] = 3;
  const std::uint64_t crc = igtl_crc(body);
  for (int i = 0; i < 8; ++i) {
    v3[std::size_t(42 + i)] = i == 7 ? std::uint8_t(body.size()) : 0;
    v3[std::size_t(50 + i)] = std::uint8_t(crc >> (8 * (7 - i)));
  }
  v3.insert(v3.end(), body.begin(), body.end());
  Listener listener;
  ASSERT_TRUE(listener.hear(v3));
  ASSERT_EQ(listener.poses.size(), 1u);
  EXPECT_NEAR(listener.poses[0].place.z, 0.10025, 1e-9);
}

TEST(Igtl, ADamagedMessageIsLeftOutAndTheNextOneIsRead) {
  Octets bad = bytes_of(kTransform);
  bad[70] ^= 1;
  Listener listener;
  ASSERT_TRUE(listener.hear(bad));
  ASSERT_TRUE(listener.hear(bytes_of(kTransform)));
  EXPECT_EQ(listener.poses.size(), 1u);
  EXPECT_EQ(listener.reader.damaged(), 1u);
}

TEST(Igtl, WhatIsNoRotationOrNoNumberIsNoPose) {
  TrackedPose pose{"Grasper", {0, 0, 0}, Mat3d::identity()};
  Listener listener;
  pose.turned.m[0][0] = 2;
  listener.hear(igtl_transform(pose));
  pose.turned.m[0][0] = -1;  // a mirror
  listener.hear(igtl_transform(pose));
  pose.turned.m[0][0] = 1;
  pose.place.x = std::numeric_limits<double>::quiet_NaN();
  listener.hear(igtl_transform(pose));
  EXPECT_TRUE(listener.poses.empty());
  EXPECT_EQ(listener.reader.damaged(), 3u);
}

TEST(Igtl, AHeaderThatCannotBeOneEndsTheStreamAndKeepsNothing) {
  Listener listener;
  Octets huge = bytes_of(kTransform);
  huge[44] = 0x7f;  // a body of many terabytes
  EXPECT_FALSE(listener.hear(huge));
  EXPECT_FALSE(listener.hear(bytes_of(kTransform)));
  EXPECT_TRUE(listener.poses.empty());
  EXPECT_LE(listener.reader.kept(), IgtlReader::kHeader);
}

}  // namespace
}  // namespace trocar::devices
