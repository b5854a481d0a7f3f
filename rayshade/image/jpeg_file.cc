// libjpeg reports errors to a function that must not return: it jumps.  Each call of libjpeg sits in a function that has no
// object with a destructor between setjmp and the jump; the message is kept and thrown from outside.
// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/image/jpeg_file.h"

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstdio>

// These need FILE.
#include <jerror.h>
#include <jpeglib.h>

namespace rayshade {
namespace {

// An empty block takes two bits at least; where it is stored for every fourth pixel, in one of several scans, less.
constexpr std::size_t kMostPerByte = 4096;
constexpr int kMostScans = 100;  // ten are usual; thousands would take hours

// libjpeg's state, and what goes with it.
struct JpegReader {
  jpeg_decompress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg_progress_mgr progress{};
  std::array<char, JMSG_LENGTH_MAX> message{};
  std::jmp_buf back;

  JpegReader();
  ~JpegReader() { jpeg_destroy_decompress(&jpeg); }
  JpegReader(const JpegReader&) = delete;
  JpegReader& operator=(const JpegReader&) = delete;
};

JpegReader& readerOf(j_common_ptr jpeg) { return *static_cast<JpegReader*>(jpeg->client_data); }

[[noreturn]] void keepMessage(j_common_ptr jpeg) {
  JpegReader& reader = readerOf(jpeg);
  jpeg->err->format_message(jpeg, reader.message.data());
  std::longjmp(reader.back, 1);
}

// libjpeg would go on with gray where data is missing or damaged.  Bytes to spare do no harm.
void refuseDamage(j_common_ptr jpeg, int level) {
  const bool harmless =
      jpeg->err->msg_code == JWRN_EXTRANEOUS_DATA || jpeg->err->msg_code == JWRN_ADOBE_XFORM;
  if (level < 0 && !harmless) keepMessage(jpeg);
}

void limitScans(j_common_ptr jpeg) {
  JpegReader& reader = readerOf(jpeg);
  if (reader.jpeg.input_scan_number <= kMostScans) return;
  std::snprintf(reader.message.data(), reader.message.size(), "more than %d scans", kMostScans);
  std::longjmp(reader.back, 1);
}

// Runs calls of libjpeg; false: it gave up.
template <class Calls>
bool succeeds(JpegReader& reader, const Calls& calls) {
  if (setjmp(reader.back) != 0) return false;
  calls();
  return true;
}

JpegReader::JpegReader() {
  jpeg.err = jpeg_std_error(&errors);
  errors.error_exit = keepMessage;
  errors.emit_message = refuseDamage;
  progress.progress_monitor = limitScans;
  jpeg.client_data = this;
}

}  // namespace

void readJpeg(std::string_view content, const std::string& name, RasterRows& to) {
  JpegReader reader;
  jpeg_decompress_struct& jpeg = reader.jpeg;
  auto run = [&](const auto& calls) {
    if (!succeeds(reader, calls)) failOn(name, std::string("damaged JPEG: ") + reader.message.data());
  };
  run([&] {
    jpeg_create_decompress(&jpeg);
    jpeg.progress = &reader.progress;
    jpeg_mem_src(&jpeg, reinterpret_cast<const unsigned char*>(content.data()), content.size());
    jpeg_read_header(&jpeg, TRUE);
  });
  if (jpeg.num_components != 1 && jpeg.num_components != 3)
    failOn(name, "a JPEG that is neither gray nor RGB");

  RasterSize size;
  size.width = static_cast<std::int32_t>(jpeg.image_width);
  size.height = static_cast<std::int32_t>(jpeg.image_height);
  size.channels = jpeg.num_components;
  countLevels(size, kMostPerByte * content.size(), name);
  to.begin(size);
  std::vector<JSAMPLE> row(size.rowLevels());
  std::vector<std::uint16_t> levels(size.rowLevels());
  run([&] {
    jpeg.out_color_space = jpeg.num_components == 1 ? JCS_GRAYSCALE : JCS_RGB;
    jpeg.dct_method = JDCT_ISLOW;
    jpeg.do_fancy_upsampling = FALSE;
    jpeg_start_decompress(&jpeg);
  });
  for (std::int32_t y = 0; y < size.height; ++y) {
    run([&] {
      JSAMPROW rows[] = {row.data()};
      jpeg_read_scanlines(&jpeg, rows, 1);
    });
    std::copy(row.begin(), row.end(), levels.begin());
    to.row(levels);
  }
  run([&] { jpeg_finish_decompress(&jpeg); });
}

}  // namespace rayshade
