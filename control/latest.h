#pragma once

#include <atomic>
#include <memory>
#include <utility>

namespace sidestep::control {

/// Hands the latest of a kind of value from one thread, which may take its time, to another, which
/// may not: one slot, no lock, and whoever takes neither allocates nor frees. What nobody took in
/// time is replaced; what has been replaced goes back, and is freed by the thread that puts.
template <class T>
class Latest {
 public:
  Latest() = default;
  ~Latest() {
    for (const Node* node : {incoming_.load(), current_}) delete node;
    Free();
  }
  Latest(const Latest&) = delete;
  Latest& operator=(const Latest&) = delete;

  /// By one thread.
  void Put(T value) {
    Free();
    auto node = std::make_unique<Node>();
    node->value = std::move(value);
    delete incoming_.exchange(node.release(), std::memory_order_acq_rel);
  }

  /// By one other thread: the latest value, null before the first. Valid until the next call.
  const T* Get() noexcept {
    if (Node* const newest = incoming_.exchange(nullptr, std::memory_order_acq_rel)) {
      if (current_ != nullptr) {
        current_->next = retired_.load(std::memory_order_relaxed);
        while (!retired_.compare_exchange_weak(current_->next, current_, std::memory_order_release,
                                               std::memory_order_relaxed)) {
        }
      }
      current_ = newest;
    }
    return current_ == nullptr ? nullptr : &current_->value;
  }

 private:
  struct Node {
    T value{};
    Node* next = nullptr;
  };

  void Free() {
    for (Node* node = retired_.exchange(nullptr, std::memory_order_acquire); node != nullptr;) {
      delete std::exchange(node, node->next);
    }
  }

  std::atomic<Node*> incoming_{nullptr}, retired_{nullptr};
  Node* current_ = nullptr;  // of the thread that gets
};

}  // namespace sidestep::control
