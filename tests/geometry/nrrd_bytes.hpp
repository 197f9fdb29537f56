// NRRD files for tests, written by hand.
#pragma once

#include <string>

#include <zlib.h>

#include "mesh_bytes.hpp"

namespace trocar::geometry {

/// A header of 2 x 3 x 2 voxels as 3D Slicer writes it, with the empty line.
inline std::string nrrd_header(const std::string& type, const std::string& encoding,
                               const std::string& endian = "little") {
  return "NRRD0004\n"
         "# Complete NRRD file format specification at:\n"
         "type: " +
         type +
         "\n"
         "dimension: 3\n"
         "space: left-posterior-superior\n"
         "sizes: 2 3 2\n"
         "space directions: (0.5,0,0) (0,0.75,0) (0,0,2)\n"
         "kinds: domain domain domain\n"
         "endian: " +
         endian +
         "\n"
         "encoding: " +
         encoding +
         "\n"
         "space origin: (-10,20,-30.5)\n"
         "Segment0_Name:=liver\n"
         "\n";
}

/// -3, -2, ... 8 as numbers of a type.
template <class T>
std::string nrrd_numbers(bool swapped) {
  MeshBytes out{swapped};
  for (int i = 0; i < 12; ++i) out.number(static_cast<T>(i - 3));
  return out.bytes;
}
inline const std::string kNrrdText = "-3 -2 -1 0 1 2\n3 4 5 6 7 8\n";

inline std::string gzipped(const std::string& bytes) {
  z_stream stream{};
  deflateInit2(&stream, 6, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY);
  std::string out(deflateBound(&stream, static_cast<uLong>(bytes.size())), '\0');
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

}  // namespace trocar::geometry
