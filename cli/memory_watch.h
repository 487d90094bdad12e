#pragma once

#include <optional>

namespace sidestep::cli {

/// Bytes of the heap that the program holds at this moment, in all its threads.
double HeldBytes();

/// Whether a program that does the same work again and again holds ever more. It holds much while
/// it works and little in between, now more and now less: what counts is the least that it held
/// when pieces of work had just been done, in the second tenth of them (in the first it makes what
/// it keeps for good) and in the last.
class MemoryWatch {
 public:
  /// @param count of the pieces of work.
  explicit MemoryWatch(int count);

  /// One more is done. @param bytes that are held now, but for what is kept of it on purpose.
  void Count(double bytes);

  /// Bytes; negative: it holds less. None until all is done.
  std::optional<double> Growth() const;

 private:
  int count_, tenth_, done_ = 0;
  std::optional<double> first_, last_;
};

}  // namespace sidestep::cli
