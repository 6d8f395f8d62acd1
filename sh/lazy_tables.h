#pragma once
/// Tables indexed by a small number (mostly the number of bands), built by the first who asks, then shared by
/// all threads without a lock.
///
///     static LazyTables<Table> tables;
///     const Table& table = tables.get(bands, [&] { return std::make_unique<Table>(bands); });

#include <array>
#include <atomic>
#include <memory>
#include <mutex>

#include "sh/basis.h"

namespace zonal::sh {

template <class Table, int kKeys = kMaxBands + 1>
class LazyTables {
 public:
  /// 0 <= key < kKeys. The reference lives as long as the program.
  template <class Make>
  const Table& get(int key, const Make& make) {
    if (const Table* table = ready_[key].load(std::memory_order_acquire)) return *table;
    const std::lock_guard lock(mutex_);
    if (!owned_[key]) {
      owned_[key] = make();
      ready_[key].store(owned_[key].get(), std::memory_order_release);
    }
    return *owned_[key];
  }

 private:
  std::array<std::atomic<const Table*>, kKeys> ready_{};
  std::array<std::unique_ptr<Table>, kKeys> owned_;
  std::mutex mutex_;
};

}  // namespace zonal::sh
