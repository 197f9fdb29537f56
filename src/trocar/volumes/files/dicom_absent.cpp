// What stands in for DICOM where the program is built without GDCM.
#ifndef TROCAR_GDCM

#include <trocar/core/error.hpp>
#include <trocar/volumes/files/dicom.hpp>

namespace trocar::volumes {
namespace {

[[noreturn]] void lacks_gdcm() {
  throw core::EnvironmentLacks(
      "this build does not read DICOM: install libgdcm-dev and build again, or convert the series to NIfTI or NRRD");
}

}  // namespace

bool reads_dicom() { return false; }
Raster read_dicom_series(const std::filesystem::path&, const std::filesystem::path&, const ReadOptions&, ReadReport&) {
  lacks_gdcm();
}
Raster read_dicom_bytes(const Source&) { lacks_gdcm(); }
std::vector<SeriesFacts> dicom_series(const std::filesystem::path&, const ReadOptions&) { lacks_gdcm(); }

}  // namespace trocar::volumes

#endif
