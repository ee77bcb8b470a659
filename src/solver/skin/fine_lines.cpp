#include "frontalis/solver/fine_lines.hpp"

#include "frontalis/error.hpp"
#include "frontalis/solver/surface_normals.hpp"
#include "solver/skin/film_equilibrium.hpp"

#include <time.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

namespace frontalis
{

// Processor time of the calling thread [s].
static double thread_seconds()
{
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct FineLines::Implementation
{
  using Vertices = std::vector<std::array<float, 3>>;

  std::shared_ptr<const Model> model;
  std::vector<FilmEquilibrium> films;  // one per law
  std::atomic<double> seconds{ 0 };
  std::vector<float> found;  // heights; used by the separate thread, or by add_to() if there is none

  // The following members are shared with the thread and protected by the mutex.
  std::mutex mutex;
  std::condition_variable wake;  // signals new vertices to the thread, and finished heights to its caller
  Vertices next;                 // vertices to find heights for; empty: none
  std::vector<float> height;     // the latest heights
  bool stop = false;
  bool busy = false;     // the thread is finding heights
  bool discard = false;  // the heights that the thread is finding are not wanted any more
  std::thread thread;

  explicit Implementation(std::shared_ptr<const Model> of)
      : model(std::move(of)), height(model->skin.vertices.size(), 0.0F)
  {
    films.reserve(model->film.laws.size());
    for (std::size_t law = 0; law < model->film.laws.size(); ++law)
      films.emplace_back(*model, law);
  }

  // Returns whether the heights are in equilibrium.
  bool find(const Vertices& vertices)
  {
    const double begin = thread_seconds();
    bool settled = true;
    for (FilmEquilibrium& film : films)
      settled = film.solve(vertices, found) < FilmEquilibrium::most_iterations && settled;
    seconds = thread_seconds() - begin;
    return settled;
  }

  void run()
  {
    std::unique_lock<std::mutex> lock(mutex);
    for (;;)
    {
      wake.wait(lock, [&] { return stop || !next.empty(); });
      if (stop)
        return;
      const Vertices vertices = std::move(next);
      next.clear();
      busy = true;
      lock.unlock();
      find(vertices);
      lock.lock();
      busy = false;
      if (std::exchange(discard, false))
        found.clear();
      else
        height = found;
      wake.notify_all();
    }
  }

  // Moves the vertices by the heights of lines.
  void raise(SkinState& skin) const
  {
    for (std::size_t v = 0; v < skin.vertices.size(); ++v)
      for (std::size_t axis = 0; axis < 3; ++axis)
        skin.vertices[v][axis] += skin.line_height[v] * skin.normals[v][axis];
    surface_normals(model->skin.triangles, skin.vertices, skin.normals);
  }
};

std::unique_ptr<FineLines> FineLines::make(std::shared_ptr<const Model> model, bool own_thread)
{
  if (model->film.laws.empty())
    return nullptr;
  return std::unique_ptr<FineLines>(new FineLines(std::move(model), own_thread));
}

FineLines::FineLines(std::shared_ptr<const Model> model, bool own_thread)
    : self_(std::make_unique<Implementation>(std::move(model)))
{
  if (own_thread)
    self_->thread = std::thread([this] { self_->run(); });
}

FineLines::~FineLines()
{
  {
    const std::lock_guard<std::mutex> lock(self_->mutex);
    self_->stop = true;
  }
  self_->wake.notify_all();
  if (self_->thread.joinable())
    self_->thread.join();
}

void FineLines::add_to(SkinState& skin, bool wait)
{
  if (self_->thread.joinable())
  {
    std::unique_lock<std::mutex> lock(self_->mutex);
    self_->next = skin.vertices;
    self_->wake.notify_all();
    if (wait)
      self_->wake.wait(lock, [&] { return self_->next.empty() && !self_->busy; });
    skin.line_height = self_->height;
  }
  else
  {
    self_->find(skin.vertices);
    skin.line_height = self_->found;
  }
  self_->raise(skin);
}

void FineLines::add_settled(SkinState& skin)
{
  constexpr int most_frames = 12;
  if (self_->thread.joinable())
    throw Error("lines of a skin that stands still are not found by a separate thread");
  self_->found.clear();
  bool settled = false;
  double seconds = 0;
  for (int frame = 0; frame < most_frames && !settled; ++frame)
  {
    settled = self_->find(skin.vertices);
    seconds += self_->seconds;
  }
  self_->seconds = seconds;
  skin.line_height = self_->found;
  self_->raise(skin);
}

void FineLines::reset()
{
  const std::lock_guard<std::mutex> lock(self_->mutex);
  self_->discard = self_->busy;
  if (!self_->busy)
    self_->found.clear();
  std::fill(self_->height.begin(), self_->height.end(), 0.0F);
  self_->next.clear();
}

double FineLines::seconds() const { return self_->seconds; }

}  // namespace frontalis
