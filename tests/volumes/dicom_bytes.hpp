// DICOM files for tests and seeds of the fuzzer, written by hand: explicit VR, little- or big-endian, not compressed.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <string>

#include "volume_bytes.hpp"

namespace trocar::volumes {

/// Elements of a data set in the order in which they are put.
struct DicomElements {
  bool big = false;
  std::string bytes;

  void tag(unsigned group, unsigned element) {
    Packed out{big, {}};
    out.put(std::uint16_t(group));
    out.put(std::uint16_t(element));
    bytes += out.bytes;
  }
  void length16(std::size_t n) {
    Packed out{big, {}};
    out.put(std::uint16_t(n));
    bytes += out.bytes;
  }
  void length32(std::size_t n) {
    Packed out{big, {}};
    out.put(std::uint32_t(n));
    bytes += out.bytes;
  }
  void text(unsigned group, unsigned element, const char* vr, std::string value) {
    if (value.size() % 2 != 0) value += std::string(vr) == "UI" ? '\0' : ' ';
    tag(group, element);
    bytes += vr;
    length16(value.size());
    bytes += value;
  }
  void number(unsigned group, unsigned element, int value) {
    tag(group, element);
    bytes += "US";
    length16(2);
    length16(std::size_t(value));
  }
  void data(unsigned group, unsigned element, const char* vr, const std::string& value) {
    tag(group, element);
    bytes += vr;
    bytes.append(2, '\0');
    length32(value.size());
    bytes += value;
  }
  /// A sequence with one item for each call's elements.
  void sequence(unsigned group, unsigned element, int items, const std::function<void(int, DicomElements&)>& fill) {
    std::string inside;
    for (int i = 0; i < items; ++i) {
      DicomElements item{big, {}};
      fill(i, item);
      DicomElements head{big, {}};
      head.tag(0xfffe, 0xe000);
      head.length32(item.bytes.size());
      inside += head.bytes + item.bytes;
    }
    data(group, element, "SQ", inside);
  }
};

struct DicomFile {
  bool big = false;
  int columns = 3, rows = 2, frames = 0;  ///< frames 0: a plain slice
  int allocated = 16, stored = 12, is_signed = 0, samples = 1;
  std::string photometric = "MONOCHROME2", modality = "CT", series = "1.2.3", position = "-10\\-20\\30";
  std::string orientation = "1\\0\\0\\0\\1\\0", spacing = "0.75\\0.5", slope = "1", intercept = "-1024";
  int instance = 1;
  bool frame_places = true;
  std::function<int(int)> pixel = [](int i) { return 1000 + i; };

  std::string bytes() const {
    DicomElements meta;
    meta.text(0x0002, 0x0002, "UI", frames > 0 ? "1.2.840.10008.5.1.4.1.1.2.1" : "1.2.840.10008.5.1.4.1.1.2");
    meta.text(0x0002, 0x0003, "UI", "1.2.3.4");
    meta.text(0x0002, 0x0010, "UI", big ? "1.2.840.10008.1.2.2" : "1.2.840.10008.1.2.1");
    DicomElements head;
    head.tag(0x0002, 0x0000);
    head.bytes += "UL";
    head.length16(4);
    head.length32(meta.bytes.size());
    std::string out(128, '\0');
    out += "DICM";
    out += head.bytes;
    out += meta.bytes;
    return out += body();
  }

 private:
  std::string body() const {
    DicomElements out{big, {}};
    out.text(0x0008, 0x0016, "UI", frames > 0 ? "1.2.840.10008.5.1.4.1.1.2.1" : "1.2.840.10008.5.1.4.1.1.2");
    out.text(0x0008, 0x0018, "UI", "1.2.3.4");
    out.text(0x0008, 0x0060, "CS", modality);
    out.text(0x0008, 0x103e, "LO", "by hand");
    if (frames == 0) out.text(0x0018, 0x0050, "DS", "2");
    out.text(0x0020, 0x000e, "UI", series);
    out.text(0x0020, 0x0013, "IS", std::to_string(instance));
    if (frames == 0) {
      out.text(0x0020, 0x0032, "DS", position);
      out.text(0x0020, 0x0037, "DS", orientation);
    }
    out.number(0x0028, 0x0002, samples);
    out.text(0x0028, 0x0004, "CS", photometric);
    if (frames > 0) out.text(0x0028, 0x0008, "IS", std::to_string(frames));
    out.number(0x0028, 0x0010, rows);
    out.number(0x0028, 0x0011, columns);
    if (frames == 0) out.text(0x0028, 0x0030, "DS", spacing);
    out.number(0x0028, 0x0100, allocated);
    out.number(0x0028, 0x0101, stored);
    out.number(0x0028, 0x0102, stored - 1);
    out.number(0x0028, 0x0103, is_signed);
    if (frames == 0) {
      out.text(0x0028, 0x1052, "DS", intercept);
      out.text(0x0028, 0x1053, "DS", slope);
    }
    if (frames > 0) groups(out);
    Packed pixels{big, {}};
    for (int i = 0; i < rows * columns * samples * std::max(frames, 1); ++i) {
      if (allocated == 8)
        pixels.put(std::uint8_t(pixel(i)));
      else
        pixels.put(std::uint16_t(pixel(i)));
    }
    if (pixels.bytes.size() % 2 != 0) pixels.bytes += '\0';
    out.data(0x7fe0, 0x0010, "OW", pixels.bytes);
    return out.bytes;
  }

  /// What an enhanced CT says of all frames and of each; the frames run backwards along the normal.
  void groups(DicomElements& out) const {
    out.sequence(0x5200, 0x9229, 1, [&](int, DicomElements& shared) {
      shared.sequence(0x0020, 0x9116, 1, [&](int, DicomElements& e) { e.text(0x0020, 0x0037, "DS", orientation); });
      shared.sequence(0x0028, 0x9110, 1, [&](int, DicomElements& e) {
        e.text(0x0018, 0x0050, "DS", "2");
        e.text(0x0028, 0x0030, "DS", spacing);
      });
      shared.sequence(0x0028, 0x9145, 1, [&](int, DicomElements& e) {
        e.text(0x0028, 0x1052, "DS", intercept);
        e.text(0x0028, 0x1053, "DS", slope);
        e.text(0x0028, 0x1054, "LO", "HU");
      });
    });
    if (!frame_places) return;
    out.sequence(0x5200, 0x9230, frames, [&](int f, DicomElements& own) {
      own.sequence(0x0020, 0x9113, 1, [&](int, DicomElements& e) {
        e.text(0x0020, 0x0032, "DS", "-10\\-20\\" + std::to_string(30 + 2 * (frames - 1 - f)));
      });
    });
  }
};

}  // namespace trocar::volumes
