// SPDX-License-Identifier: Apache-2.0
#include "global_planner/tour/internal/local_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace headland::tour {
namespace {

// Symbols: t1..t6 are the ends of the removed edges (t1, t2), (t3, t4), (t5, t6); the added ones
// are (t2, t3), (t4, t5), (t6, t1), or (t4, t1) with two edges (Lin and Kernighan 1973).

constexpr int kThirdBreadth = 5;  // neighbours tried for the third edge
// Segments of a kick are mostly short, so that it costs little; now and then long enough to change
// the order of whole blocks.
constexpr int kShortSegment = 30;
constexpr int kLongSegment = 300;
constexpr double kLongShare = 0.1;

}  // namespace

LocalSearch::LocalSearch(const Cycle& cycle, const Neighbours& neighbours, Entries entries)
    : cycle_(cycle),
      neighbours_(neighbours),
      entries_(std::move(entries)),
      position_(entries_.size()),
      turn_back_(entries_.size(), 0.0),
      least_gain_(1e-6 * cycle.step()),
      queue_(2 * entries_.size()),
      queued_(2 * entries_.size(), 0),
      kept_(entries_),
      touched_first_(static_cast<int>(entries_.size())) {
  refresh(0, rows() - 1);
  cost_ = recompute_cost();
  kept_cost_ = cost_;
}

int LocalSearch::edge_of(int end) const {
  const int p = position(end);
  if (at(p) != end) return p;
  return p == 0 ? rows() - 1 : p - 1;
}

int LocalSearch::mate(int end) const {
  const int p = position(end);
  if (at(p) != end) return next_at(p);
  return at(p == 0 ? rows() - 1 : p - 1) ^ 1;
}

double LocalSearch::reversal(int first, int last) const {
  return turn_back_[static_cast<std::size_t>(last)] - turn_back_[static_cast<std::size_t>(first)];
}

void LocalSearch::enqueue(int end) {
  if (queued_[static_cast<std::size_t>(end)]) return;
  queued_[static_cast<std::size_t>(end)] = 1;
  const int size = static_cast<int>(queue_.size());
  int tail = queue_head_ + queue_size_++;
  if (tail >= size) tail -= size;
  queue_[static_cast<std::size_t>(tail)] = end;
}

void LocalSearch::enqueue_edge(int edge) {
  enqueue(at(edge) ^ 1);
  enqueue(next_at(edge));
}

void LocalSearch::enqueue_all() {
  for (int p = 0; p < rows(); ++p) enqueue_edge(p);
}

void LocalSearch::descend() {
  while (queue_size_ > 0) {
    const int end = queue_[static_cast<std::size_t>(queue_head_)];
    if (++queue_head_ == static_cast<int>(queue_.size())) queue_head_ = 0;
    --queue_size_;
    queued_[static_cast<std::size_t>(end)] = 0;
    while (improve_at(end)) {
    }
  }
}

// Applies the best move that removes the edge at t1, if it gains.
bool LocalSearch::improve_at(int t1) {
  const int t2 = mate(t1);
  Move best;
  best.change = -least_gain_;
  const double removed = edge_cost(edge_of(t1));
  for (const Neighbour& n3 : neighbours_[static_cast<std::size_t>(t2)]) {
    const double gain1 = removed - static_cast<double>(n3.cost);
    if (gain1 <= least_gain_) break;
    const int t3 = n3.end;
    if (t3 == t1) continue;
    const int t4 = mate(t3);
    if (is_entry(t3) == is_entry(t2)) try_two(t1, t3, best);
    const double sum2 = gain1 + edge_cost(edge_of(t3));
    int breadth = kThirdBreadth;
    for (const Neighbour& n5 : neighbours_[static_cast<std::size_t>(t4)]) {
      if (sum2 - static_cast<double>(n5.cost) <= least_gain_ || breadth-- == 0) break;
      const int t5 = n5.end;
      if (t5 == t1 || t5 == t2 || t5 == t3) continue;
      try_three({t1, t2, t3, t4, t5, mate(t5)}, best);
    }
  }
  if (best.kind == Kind::kNone) return false;
  apply(best);
  return true;
}

void LocalSearch::try_two(int t1, int t3, Move& best) const {
  int i = edge_of(t1);
  int j = edge_of(t3);
  if (i > j) std::swap(i, j);
  const int a = at(i) ^ 1;
  const int b = at(i + 1);
  const int c = at(j) ^ 1;
  const int d = next_at(j);
  const double change = cycle_.directed(a, c) + cycle_.directed(b, d) + reversal(i + 1, j) -
                        cycle_.directed(a, b) - cycle_.directed(c, d);
  if (change < best.change) best = {Kind::kBr, change, i, j, j};
}

void LocalSearch::try_three(const int (&t)[6], Move& best) const {
  int i = edge_of(t[0]);
  int j = edge_of(t[2]);
  int k = edge_of(t[4]);
  if (i > j) std::swap(i, j);
  if (j > k) std::swap(j, k);
  if (i > j) std::swap(i, j);
  const int a = at(i) ^ 1;
  const int b = at(i + 1);
  const int c = at(j) ^ 1;
  const int d = at(j + 1);
  const int e = at(k) ^ 1;
  const int f = next_at(k);
  const auto partner = [&t](int end) {
    for (int x = 0; x < 6; ++x) {
      if (t[x] == end) return t[x % 2 == 0 ? (x + 5) % 6 : (x + 1) % 6];
    }
    return -1;
  };
  const int pa = partner(a);
  const int pb = partner(b);
  const auto cost = [this](int from, int to) { return cycle_.directed(from, to); };
  Move move{Kind::kNone, -cost(a, b) - cost(c, d) - cost(e, f), i, j, k};
  if (pa == d && pb == e) {
    move.kind = Kind::kCB;
    move.change += cost(a, d) + cost(e, b) + cost(c, f);
  } else if (pa == d && pb == f) {
    move.kind = Kind::kCBr;
    move.change += cost(a, d) + cost(e, c) + cost(b, f) + reversal(i + 1, j);
  } else if (pa == e && pb == d) {
    move.kind = Kind::kCrB;
    move.change += cost(a, e) + cost(d, b) + cost(c, f) + reversal(j + 1, k);
  } else if (pa == c && pb == e) {
    move.kind = Kind::kBrCr;
    move.change += cost(a, c) + cost(b, e) + cost(d, f) + reversal(i + 1, j) + reversal(j + 1, k);
  } else {
    return;  // more than one cycle
  }
  if (move.change < best.change) best = move;
}

void LocalSearch::apply(const Move& move) {
  const auto [kind, change, i, j, k] = move;
  if (kind == Kind::kBr || kind == Kind::kCBr || kind == Kind::kBrCr) reverse(i + 1, j);
  if (kind == Kind::kCrB || kind == Kind::kBrCr) reverse(j + 1, k);
  int cut = j;  // behind which the second edge now lies
  if (kind == Kind::kCB || kind == Kind::kCrB || kind == Kind::kCBr) {
    std::rotate(entries_.begin() + i + 1, entries_.begin() + j + 1, entries_.begin() + k + 1);
    cut = i + (k - j);
  }
  refresh(i + 1, k);
  touch(i + 1, k);
  cost_ += change;
  for (const int edge : {i, cut, k}) enqueue_edge(edge);
}

void LocalSearch::reverse(int first, int last) {
  std::reverse(entries_.begin() + first, entries_.begin() + last + 1);
  for (int p = first; p <= last; ++p) entries_[static_cast<std::size_t>(p)] ^= 1;
}

// Brings positions and prefix sums up to date after the rows at first..last changed.
void LocalSearch::refresh(int first, int last) {
  for (int p = first; p <= last; ++p) {
    position_[static_cast<std::size_t>(at(p) / 2)] = p;
  }
  if (cycle_.symmetric()) return;
  // The depot's own edges are never reversed, nor read: leave them out of the sums.
  const int stop = std::min(last + 1, rows() - 1);
  const double old_sum = turn_back_[static_cast<std::size_t>(stop)];
  for (int p = std::max(first, 2); p <= stop; ++p) {
    const double backward = cycle_.directed(at(p), at(p - 1) ^ 1);
    const double forward = cycle_.directed(at(p - 1) ^ 1, at(p));
    turn_back_[static_cast<std::size_t>(p)] =
        turn_back_[static_cast<std::size_t>(p - 1)] + backward - forward;
  }
  const double shift = turn_back_[static_cast<std::size_t>(stop)] - old_sum;
  for (int p = stop + 1; p < rows(); ++p) turn_back_[static_cast<std::size_t>(p)] += shift;
}

void LocalSearch::touch(int first, int last) {
  touched_first_ = std::min(touched_first_, first);
  touched_last_ = std::max(touched_last_, last);
}

void LocalSearch::kick(RandomStream& random) {
  const int limit = random.uniform() < kLongShare ? kLongSegment : kShortSegment;
  const int longest = std::min(limit, (rows() - 1) / 3);
  const int b = 1 + random.index(longest);
  const int c = 1 + random.index(longest);
  const int d = 1 + random.index(longest);
  // A B C D -> A D C B
  const int i = random.index(rows() - (b + c + d));
  const auto begin = entries_.begin() + i + 1;
  scratch_.assign(begin, begin + b + c + d);
  const int sizes_before = b + c;
  auto out = std::copy(scratch_.begin() + sizes_before, scratch_.end(), begin);
  out = std::copy(scratch_.begin() + b, scratch_.begin() + sizes_before, out);
  std::copy(scratch_.begin(), scratch_.begin() + b, out);
  const int last = i + b + c + d;
  const auto old_cost = [&](int from, int to) { return cycle_.directed(from, to); };
  const int before = at(i) ^ 1;
  const int after = next_at(last);
  const auto s = [this](int x) { return scratch_[static_cast<std::size_t>(x)]; };
  cost_ -= old_cost(before, s(0)) + old_cost(s(b - 1) ^ 1, s(b)) +
           old_cost(s(b + c - 1) ^ 1, s(b + c)) + old_cost(s(b + c + d - 1) ^ 1, after);
  for (const int edge : {i, i + d, i + d + c, last}) {
    cost_ += edge_cost(edge);
  }
  refresh(i + 1, last);
  touch(i + 1, last);
  for (const int edge : {i, i + d, i + d + c, last}) enqueue_edge(edge);
}

void LocalSearch::keep() {
  if (touched_first_ <= touched_last_) {
    std::copy(entries_.begin() + touched_first_, entries_.begin() + touched_last_ + 1,
              kept_.begin() + touched_first_);
  }
  kept_cost_ = cost_;
  touched_first_ = rows();
  touched_last_ = -1;
}

void LocalSearch::undo() {
  if (touched_first_ <= touched_last_) {
    std::copy(kept_.begin() + touched_first_, kept_.begin() + touched_last_ + 1,
              entries_.begin() + touched_first_);
    refresh(touched_first_, touched_last_);
  }
  cost_ = kept_cost_;
  touched_first_ = rows();
  touched_last_ = -1;
}

double LocalSearch::recompute_cost() const {
  double sum = 0.0;
  for (int p = 0; p < rows(); ++p) sum += edge_cost(p);
  return sum;
}

namespace {
constexpr int kPollEvery = 64;  // kicks
}  // namespace

Entries iterated_local_search(const Cycle& cycle, const Neighbours& neighbours, Entries entries,
                              int iterations, double stop_cost, std::uint64_t seed,
                              const std::function<bool()>& stop) {
  RandomStream random(seed, "row tour");
  LocalSearch search(cycle, neighbours, std::move(entries));
  search.enqueue_all();
  search.descend();
  search.keep();
  Entries best = search.entries();
  double best_cost = search.cost();
  double current = best_cost;
  for (int iteration = 0; iteration < iterations && best_cost > stop_cost; ++iteration) {
    if (stop && iteration % kPollEvery == 0 && stop()) break;
    search.kick(random);
    search.descend();
    // Slightly dearer orders are kept too, ever fewer of them.
    const double warmth = cycle.step() * (1.0 - iteration / static_cast<double>(iterations));
    if (search.cost() < current - warmth * std::log(1.0 - random.uniform())) {
      search.keep();
      current = search.cost();
      if (current < best_cost - 1e-9 * cycle.step()) {
        best_cost = current;
        best = search.entries();
      }
    } else {
      search.undo();
    }
  }
  return best;
}

}  // namespace headland::tour
