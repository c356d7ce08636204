// What the project takes of TBB, by threads that ThreadSanitizer sees: for
// GFXREPRO_SANITIZE_THREADS, as TBB itself is a library built without it, whose every handing over
// of work looks like a race. Loops are cut into pieces, of which each of a few threads takes every
// third.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <thread>

namespace tbb {

template <class T>
class blocked_range {
  public:
    blocked_range(T begin, T end) : begin_(begin), end_(end) {}
    T begin() const { return begin_; }
    T end() const { return end_; }

  private:
    T begin_, end_;
};

constexpr std::size_t kThreads = 3, kPieces = 12;

/// Calls body(piece, range) for each piece that is not empty.
template <class T, class Body>
void forPieces(const blocked_range<T>& range, const Body& body) {
    const auto count = static_cast<std::size_t>(range.end() - range.begin());
    const auto from = [&](std::size_t piece) {
        return range.begin() + static_cast<T>(count * piece / kPieces);
    };
    const auto run = [&](std::size_t thread) {
        for (std::size_t piece = thread; piece < kPieces; piece += kThreads) {
            const blocked_range<T> part(from(piece), from(piece + 1));
            if (part.begin() < part.end()) body(piece, part);
        }
    };
    std::array<std::thread, kThreads> threads;
    for (std::size_t i = 0; i < kThreads; ++i) threads[i] = std::thread(run, i);
    for (std::thread& thread : threads) thread.join();
}

template <class T, class Body>
void parallel_for(const blocked_range<T>& range, const Body& body) {
    if (!(range.begin() < range.end())) return;
    forPieces(range, [&](std::size_t, const blocked_range<T>& part) { body(part); });
}

template <class T, class Body>
void parallel_for(T begin, T end, const Body& body) {
    parallel_for(blocked_range<T>(begin, end), [&](const blocked_range<T>& part) {
        for (T i = part.begin(); i < part.end(); ++i) body(i);
    });
}

template <class T, class Value, class Body, class Join>
Value parallel_reduce(const blocked_range<T>& range, const Value& identity, const Body& body,
                      const Join& join) {
    std::array<Value, kPieces> values;
    values.fill(identity);
    forPieces(range, [&](std::size_t piece, const blocked_range<T>& part) {
        values[piece] = body(part, identity);
    });
    Value value = identity;
    for (const Value& one : values) value = join(value, one);
    return value;
}

template <class First, class Second>
void parallel_invoke(const First& first, const Second& second) {
    std::thread other(second);
    first();
    other.join();
}

template <class Iterator, class Less = std::less<>>
void parallel_sort(Iterator begin, Iterator end, const Less& less = {}) {
    std::sort(begin, end, less);
}

}  // namespace tbb
