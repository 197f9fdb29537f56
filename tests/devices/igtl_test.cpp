// What a tracker says: known messages, in pieces, damaged, and of other kinds. The bytes of the known ones were packed
// by the OpenIGTLink library, 1.11.
#include <cmath>
#include <cstring>
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
  std::vector<UnseenTool> unseen;
  std::vector<SensorValues> values;
  bool hear(const Octets& bytes) {
    return reader.hear(bytes, {[this](const TrackedPose& p) { poses.push_back(p); },
                               [this](const UnseenTool& u) { unseen.push_back(u); },
                               [this](const SensorValues& v) { values.push_back(v); }});
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

TrackedPose somewhere(const std::string& name) { return {name, {0.008, 0.02, 0.03}, Mat3d::identity()}; }

void add_float(Octets& out, float value) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  for (int shift = 24; shift >= 0; shift -= 8) out.push_back(std::uint8_t(bits >> shift));
}
/// An element of TDATA (twelve numbers) or QTDATA (seven).
void add_tool(Octets& out, const std::string& name, std::uint8_t kind, const std::vector<float>& numbers) {
  for (std::size_t i = 0; i < 20; ++i) out.push_back(i < name.size() ? std::uint8_t(name[i]) : 0);
  out.push_back(kind);
  out.push_back(0);
  for (const float number : numbers) add_float(out, number);
}
const std::vector<float> kMatrix = {1, 0, 0, 0, 1, 0, 0, 0, 1, 8, 20, 30};

TEST(Igtl, AToolIsNotSeenWhileItsServerSaysSo) {
  for (const int version : {2, 3})
    for (const char* status : {"MISSING", "OUT_OF_VIEW", "OUT_OF_VOLUME", "TOOL_MISSING", "invalid", "UNKNOWN"}) {
      Listener listener;
      listener.hear(igtl_transform(somewhere("Left"), version, {{"TransformStatus", "OK"}}));
      listener.hear(igtl_transform(somewhere("Left"), version, {{"TransformStatus", status}}));
      EXPECT_EQ(listener.poses.size(), 1u) << status;
      ASSERT_EQ(listener.unseen.size(), 1u) << status;
      EXPECT_EQ(listener.unseen[0].name, "Left");
      EXPECT_EQ(listener.reader.damaged(), 0u) << "a tool that is not seen is no damage";
    }
  Listener listener;
  listener.hear(igtl_transform(somewhere("Left"), 2, {{"TransformValid", "0"}}));
  listener.hear(igtl_transform(somewhere("Left"), 2, {{"Status", "MISSING"}, {"TransformStatus", "OK"}}));
  EXPECT_EQ(listener.unseen.size(), 2u) << "one text that says so is enough";
  listener.hear(igtl_transform(somewhere("Left"), 2, {{"TransformStatus", "SWITCH1_IS_ON"}}));
  listener.hear(igtl_transform(somewhere("Left"), 2, {{"MRMLNodeName", "MISSING"}}));
  EXPECT_EQ(listener.poses.size(), 2u) << "a pressed button, and a text about something else";
}

TEST(Igtl, ToolsOfOneMessageAreSeenOrNotEachByItself) {
  Octets tools;
  add_tool(tools, "LeftToReference", 2, kMatrix);
  add_tool(tools, "RightToReference", 2, kMatrix);
  Listener listener;
  listener.hear(igtl_message("TDATA", "Tracker", tools, 2,
                             {{"LeftToReferenceStatus", "OUT_OF_VIEW"}, {"RightToReferenceStatus", "OK"}}));
  ASSERT_EQ(listener.unseen.size(), 1u);
  EXPECT_EQ(listener.unseen[0].name, "LeftToReference");
  EXPECT_EQ(listener.unseen[0].why, "OUT_OF_VIEW");
  ASSERT_EQ(listener.poses.size(), 1u);
  EXPECT_EQ(listener.poses[0].name, "RightToReference");
  listener.hear(igtl_message("TDATA", "Tracker", tools, 2, {{"TransformStatus", "MISSING"}}));
  EXPECT_EQ(listener.unseen.size(), 3u) << "said of the whole message";
}

TEST(Igtl, AStatusOfAToolThatIsNotOkSaysThatItIsNotSeen) {
  Octets status = {0, 13, 0, 0, 0, 0, 0, 0, 0, 0};  // not ready
  status.resize(30);
  std::memcpy(&status[10], "NotReady", 8);
  status.push_back(0);
  Listener listener;
  listener.hear(igtl_message("STATUS", "Left", status));
  listener.hear(igtl_message("STATUS", "Left", status, 3));
  ASSERT_EQ(listener.unseen.size(), 2u);
  EXPECT_EQ(listener.unseen[1].why, "NotReady");
  listener.hear(bytes_of(kStatus));
  EXPECT_EQ(listener.unseen.size(), 2u) << "the library's own says OK";
  EXPECT_EQ(listener.reader.damaged(), 0u);
}

TEST(Igtl, TheExactIdentityIsNoPlaceOfATool) {
  Listener listener;
  listener.hear(igtl_transform({"Left", {}, Mat3d::identity()}));
  ASSERT_EQ(listener.unseen.size(), 1u);
  EXPECT_EQ(listener.unseen[0].why, kSentAsIdentity);
  listener.hear(igtl_transform({"Left", {0, 1e-6, 0}, Mat3d::identity()}));
  listener.hear(igtl_transform({"Left", {}, Mat3d::identity()}, 2, {{"TransformStatus", "OK"}}));
  EXPECT_EQ(listener.poses.size(), 2u) << "beside it, or where the server calls it seen";
}

TEST(Igtl, NamesAreCutTo20LettersUnlessTheServerSendsTheWhole) {
  const std::string whole = "LeftGrasperTipToReference", cut = whole.substr(0, 20);
  Listener listener;
  listener.hear(igtl_transform(somewhere(whole)));
  listener.hear(igtl_transform(somewhere(whole), 2, {{"IGTL_DEVICE_NAME", whole}}));
  listener.hear(igtl_transform(somewhere(whole), 3, {{"NodeName", whole}}));
  Octets tools;
  add_tool(tools, whole, 2, kMatrix);
  listener.hear(igtl_message("TDATA", "Tracker", tools, 2, {{whole + "Status", "OK"}}));
  listener.hear(igtl_message("TDATA", "Tracker", tools, 2, {{cut + "Status", "MISSING"}}));
  ASSERT_EQ(listener.poses.size(), 4u);
  EXPECT_EQ(listener.poses[0].name, cut);
  for (std::size_t i = 1; i < 4; ++i) EXPECT_EQ(listener.poses[i].name, whole) << i;
  ASSERT_EQ(listener.unseen.size(), 1u);
  EXPECT_EQ(listener.unseen[0].name, cut);
  EXPECT_TRUE(same_tool_name(whole, cut) && same_tool_name(cut, whole) && same_tool_name(whole, whole));
  EXPECT_FALSE(same_tool_name("Left", "LeftTool")) << "only a name of 20 letters may have been cut";
}

TEST(Igtl, PositionsAndToolsWithQuaternionsAreRead) {
  Octets position;
  for (const float number : {8.f, 20.f, 30.f, 0.f, 0.f, std::sin(0.25f)}) add_float(position, number);
  Octets tools;
  add_tool(tools, "Left", 2, {8, 20, 30, 0, 0, std::sin(0.25f), std::cos(0.25f)});
  add_tool(tools, "Tip", 3, {8, 20, 30, 0, 0, 0, 0});  // measured without a rotation
  Listener listener;
  listener.hear(igtl_message("POSITION", "Left", position));
  listener.hear(igtl_message("QTDATA", "Tracker", tools, 2));
  ASSERT_EQ(listener.poses.size(), 3u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(length(listener.poses[i].place - Vec3d{0.008, 0.02, 0.03}), 0, 1e-8);
    EXPECT_NEAR(listener.poses[i].turned.m[1][0], std::sin(0.5), 1e-6) << "a turn by 0.5 rad about z";
  }
  EXPECT_EQ(listener.poses[2].turned.m[1][1], 1);
  Octets none;
  add_tool(none, "Left", 2, {8, 20, 30, 0, 0, 0, 0});
  listener.hear(igtl_message("QTDATA", "Tracker", none));
  EXPECT_EQ(listener.poses.size(), 3u);
  EXPECT_EQ(listener.reader.damaged(), 1u) << "a quaternion of zeros is no rotation";
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
