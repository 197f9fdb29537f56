// Volumes as files for tests and seeds of the fuzzer, written by hand: 2 x 3 x 2 voxels with the numbers -3 .. 8.
#pragma once

#include <array>
#include <cstring>
#include <string>
#include <vector>

#include <zlib.h>

namespace trocar::volumes {

struct Packed {
  bool big = false;
  std::string bytes;

  template <class T>
  void put(T value) {
    char own[sizeof(T)];
    std::memcpy(own, &value, sizeof(T));
    for (std::size_t i = 0; i < sizeof(T); ++i) bytes += own[big ? sizeof(T) - 1 - i : i];
  }
};

template <class T>
std::string twelve_numbers(bool big = false) {
  Packed out{big, {}};
  for (int i = 0; i < 12; ++i) out.put(static_cast<T>(i - 3));
  return out.bytes;
}

inline std::string deflated(const std::string& bytes, bool gzip = true) {
  z_stream stream{};
  deflateInit2(&stream, 6, Z_DEFLATED, 15 + (gzip ? 16 : 0), 8, Z_DEFAULT_STRATEGY);
  std::string out(deflateBound(&stream, static_cast<uLong>(bytes.size())) + 64, '\0');
  std::string in = bytes;
  stream.next_in = reinterpret_cast<Bytef*>(in.data());
  stream.avail_in = static_cast<uInt>(in.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

struct Nifti {
  bool big = false;
  std::array<int, 8> dim{3, 2, 3, 2, 1, 1, 1, 1};
  int datatype = 4, bits = 16, qform = 0, sform = 1, units = 2;
  std::array<float, 8> pixdim{1, 0.5f, 0.75f, 2, 1, 1, 1, 1};
  float vox_offset = 352, slope = 0, intercept = 0;
  std::array<float, 6> quaternion{0, 0, 0, 10, 20, 30};
  std::array<float, 12> srow{-0.5f, 0, 0, 10, 0, 0.75f, 0, 20, 0, 0, 2, 30};  // R A S

  std::string header() const {
    Packed h{big, {}};
    h.put(std::int32_t(348));
    h.bytes.resize(40, '\0');
    for (const int d : dim) h.put(std::int16_t(d));
    h.bytes.resize(70, '\0');
    h.put(std::int16_t(datatype));
    h.put(std::int16_t(bits));
    h.bytes.resize(76, '\0');
    for (const float p : pixdim) h.put(p);
    h.put(vox_offset);
    h.put(slope);
    h.put(intercept);
    h.bytes.resize(123, '\0');
    h.bytes += char(units);
    h.bytes.resize(252, '\0');
    h.put(std::int16_t(qform));
    h.put(std::int16_t(sform));
    for (const float q : quaternion) h.put(q);
    for (const float s : srow) h.put(s);
    h.bytes.resize(344, '\0');
    h.bytes.append("n+1\0", 4);
    h.bytes.append(4, '\0');
    return h.bytes;
  }
};

/// A header of NIfTI-2 of the same volume.
inline std::string nifti2_header() {
  Packed h;
  h.put(std::int32_t(540));
  h.bytes.append("n+2\0\r\n\032\n", 8);
  h.put(std::int16_t(4));
  h.put(std::int16_t(16));
  for (const int d : {3, 2, 3, 2, 1, 1, 1, 1}) h.put(std::int64_t(d));
  h.bytes.resize(104, '\0');
  for (const double p : {1.0, 0.5, 0.75, 2.0, 1.0, 1.0, 1.0, 1.0}) h.put(p);
  h.put(std::int64_t(544));
  h.put(1.0);
  h.put(0.0);
  h.bytes.resize(344, '\0');
  h.put(std::int32_t(0));
  h.put(std::int32_t(1));
  h.bytes.resize(400, '\0');
  for (const double s : {-0.5, 0.0, 0.0, 10.0, 0.0, 0.75, 0.0, 20.0, 0.0, 0.0, 2.0, 30.0}) h.put(s);
  h.put(std::int32_t(0));
  h.bytes.resize(500, '\0');
  h.put(std::int32_t(2));
  h.bytes.resize(544, '\0');
  return h.bytes;
}

/// The same volume's header in NRRD; without the empty line.
inline std::string nrrd_fields(const std::string& type, const std::string& encoding,
                               const std::string& endian = "little") {
  return "NRRD0004\n# made by hand\ntype: " + type +
         "\ndimension: 3\nspace: left-posterior-superior\nsizes: 2 3 2\n"
         "space directions: (0.5,0,0) (0,-0.75,0) (0,0,2)\nkinds: domain domain domain\nendian: " +
         endian + "\nencoding: " + encoding + "\nspace origin: (-10,-20,30)\n";
}
inline const std::string kTwelveText = "-3 -2 -1 0 1 2\n3 4 5 6 7 8\n";

/// And in MetaImage.
inline std::string meta_fields(const std::string& type, bool packed, const std::string& data = "LOCAL",
                               bool big = false) {
  return "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = " +
         std::string(big ? "True" : "False") + "\nCompressedData = " + (packed ? "True" : "False") +
         "\nTransformMatrix = 1 0 0 0 -1 0 0 0 1\nOffset = -10 -20 30\nCenterOfRotation = 0 0 0\n"
         "ElementSpacing = 0.5 0.75 2\nDimSize = 2 3 2\nElementType = " +
         type + "\nElementDataFile = " + data + "\n";
}

}  // namespace trocar::volumes
