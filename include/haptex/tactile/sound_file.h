// Displacements of a contactor as a sound.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace haptex::tactile {

/// Full scale of a sound: fabrics under an ordinary stroke stay below, and smooth ones are heard.
constexpr double kFullScale = 5e-5;       ///< m
constexpr int kSoundRate = 44100;         ///< Hz
constexpr double kLongestSound = 3600.0;  ///< s

/// What became of a sound.
struct WrittenSound {
  std::size_t samples = 0;
  std::size_t clipped = 0;  ///< samples beyond full scale, written as full scale
  double largest = 0.0;     ///< m, displacement
};

/// A WAV file of 16 bits, one channel, kSoundRate, that is written sample by sample.
class SoundFile {
 public:
  /// @throws std::runtime_error naming the file if it cannot be written
  explicit SoundFile(const std::string& path);
  ~SoundFile();
  SoundFile(const SoundFile&) = delete;
  SoundFile& operator=(const SoundFile&) = delete;

  /// The next sample. @param displacement m, finite
  void add(double displacement);
  /// Writes what was added. @throws as the constructor
  void write();
  /// The same, and makes the file whole up to there: who is killed leaves a sound. @throws likewise
  void flush();
  /// Flushes, and ends the file. Nothing may be added any more. @throws likewise
  void close();

  const WrittenSound& written() const { return written_; }

 private:
  struct File;

  [[noreturn]] void fail() const;

  std::string path_;
  std::unique_ptr<File> file_;
  std::vector<short> samples_;  // not yet written
  WrittenSound written_;
};

}  // namespace haptex::tactile
