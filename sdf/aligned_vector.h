#pragma once

#include <cstddef>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace sidestep::sdf {

/// Gives memory at cache lines, and leaves numbers in it as they are until they are written.
template <class T>
class AlignedAllocator {
 public:
  using value_type = T;
  static constexpr std::align_val_t kAlignment{64};

  AlignedAllocator() = default;
  template <class U>
  AlignedAllocator(const AlignedAllocator<U>&) {}  // NOLINT: allocators convert

  T* allocate(std::size_t count) {
    return static_cast<T*>(::operator new(count * sizeof(T), kAlignment));
  }
  void deallocate(T* memory, std::size_t) { ::operator delete(memory, kAlignment); }

  template <class U>
  void construct(U* place) noexcept(std::is_nothrow_default_constructible_v<U>) {
    ::new (static_cast<void*>(place)) U;
  }
  template <class U, class... Arguments>
  void construct(U* place, Arguments&&... arguments) {
    ::new (static_cast<void*>(place)) U(std::forward<Arguments>(arguments)...);
  }

  bool operator==(const AlignedAllocator&) const = default;
};

/// A vector that begins at a cache line. AlignedVector<float>(n) is *not* set to zero:
/// AlignedVector<float>(n, 0.0F) is.
template <class T>
using AlignedVector = std::vector<T, AlignedAllocator<T>>;

}  // namespace sidestep::sdf
