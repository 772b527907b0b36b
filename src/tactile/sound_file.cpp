#include "haptex/tactile/sound_file.h"

#include <sndfile.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace haptex::tactile {
namespace {

constexpr double kMaxSample = 32767.0;

}  // namespace

struct SoundFile::File {
  SNDFILE* handle = nullptr;

  ~File() {
    if (handle) sf_close(handle);
  }
};

SoundFile::SoundFile(const std::string& path) : path_(path), file_(std::make_unique<File>()) {
  SF_INFO info{};
  info.samplerate = kSoundRate;
  info.channels = 1;
  info.format = SF_FORMAT_WAV | SF_FORMAT_PCM_16;
  file_->handle = sf_open(path.c_str(), SFM_WRITE, &info);
  if (!file_->handle) fail();
}

SoundFile::~SoundFile() = default;

void SoundFile::fail() const {
  throw std::runtime_error(path_ + ": cannot be written: " + sf_strerror(file_->handle));
}

void SoundFile::add(double displacement) {
  written_.largest = std::max(written_.largest, std::abs(displacement));
  if (std::abs(displacement) > kFullScale) ++written_.clipped;
  const double share = std::clamp(displacement / kFullScale, -1.0, 1.0);
  samples_.push_back(static_cast<short>(std::lround(kMaxSample * share)));
  ++written_.samples;
}

void SoundFile::write() {
  const auto count = static_cast<sf_count_t>(samples_.size());
  if (sf_write_short(file_->handle, samples_.data(), count) != count) fail();
  samples_.clear();
}

void SoundFile::flush() {
  write();
  // Otherwise the header says how long the file was when it was opened.
  sf_command(file_->handle, SFC_UPDATE_HEADER_NOW, nullptr, 0);
  sf_write_sync(file_->handle);
  if (sf_error(file_->handle) != SF_ERR_NO_ERROR) fail();
}

void SoundFile::close() {
  flush();
  SNDFILE* handle = file_->handle;
  file_->handle = nullptr;
  if (sf_close(handle) != 0) fail();
}

}  // namespace haptex::tactile
