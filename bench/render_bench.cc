// SPDX-License-Identifier: Apache-2.0
// What a picture costs in the size of golden ones: drawing it, finding the thing at each pixel,
// comparing it. docs/speed.md asks for at most 150 ms of processor time for a frame and 2 ms for a
// comparison of equal hashes. LP_NUM_THREADS=0 keeps the rasteriser in the thread that is timed.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <string>

#include "harness/base/base/project_paths.h"
#include "harness/episode/run/load_run.h"
#include "harness/episode/run/run_scenario.h"
#include "harness/show/pictures/scenery.h"
#include "render/inventory.h"
#include "render/picture.h"

namespace prehend::bench {
namespace {

/// A played scenario and one of its pictures.
class Scene {
 public:
  Scene(const std::string& file, const std::string& moment) {
    setenv("LP_NUM_THREADS", "0", /*overwrite=*/0);
    const std::string root = FindProjectRoot().value_or(".");
    loaded_ = *episode::LoadRun({.scenario_file = root + "/scenarios/" + file}, root);
    run_ = episode::RunScenario(loaded_.scenario, loaded_.program, {.record = true});
    scenario::PictureYaml entry;
    entry.at.value = moment;
    entry.camera.value = "three_quarter";
    picture_ = show::ComposePicture(loaded_.scenario, run_, entry, show::kGoldenFormat);
  }
  const render::Picture& picture() const { return picture_; }

 private:
  episode::LoadedRun loaded_;
  episode::RunResult run_;
  render::Picture picture_;
};

const Scene& Carton() {
  static const Scene scene("pick_and_place/milk_carton_wrap.yaml", "transporting.begin");
  return scene;
}
const Scene& Person() {
  static const Scene scene("body/arm_follows_the_hand.yaml", "transporting.begin");
  return scene;
}
const Scene& Grains() {
  static const Scene scene("pouring/two_hundred_grains_are_poured_into_a_bowl.yaml",
                           "pouring.begin");
  return scene;
}

/// Shaders are compiled once per process, by the first picture.
render::Painter& WarmPainter(const render::Picture& picture) {
  static render::Painter painter;
  benchmark::DoNotOptimize(painter.Draw(picture).rgb.data());
  return painter;
}

void Frame(benchmark::State& state, const Scene& (*scene)()) {
  const render::Picture& picture = scene().picture();
  render::Painter& painter = WarmPainter(picture);
  for (auto _ : state) benchmark::DoNotOptimize(painter.Draw(picture).rgb.data());
}
BENCHMARK_CAPTURE(Frame, carton, Carton)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Frame, person, Person)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Frame, grains, Grains)->Unit(benchmark::kMillisecond);

void ThingsOfAFrame(benchmark::State& state) {
  const render::Picture& picture = Carton().picture();
  render::Painter& painter = WarmPainter(picture);
  for (auto _ : state) benchmark::DoNotOptimize(painter.DrawIds(picture).ids.data());
}
BENCHMARK(ThingsOfAFrame)->Unit(benchmark::kMillisecond);

/// Hash of the drawn pixels, and every thing of both inventories.
void CompareEqualHashes(benchmark::State& state) {
  const render::ListedPicture drawn =
      WarmPainter(Carton().picture()).DrawListed(Carton().picture());
  for (auto _ : state) {
    if (render::PixelHash(drawn.image) != drawn.inventory.pixels ||
        !render::TellApart(
             drawn.inventory, [] { return render::Image(); }, drawn)
             .empty())
      state.SkipWithError("a picture differs from itself");
  }
}
BENCHMARK(CompareEqualHashes)->Unit(benchmark::kMillisecond);

/// As a picture that differs is compared: pixel by pixel.
void ComparePixels(benchmark::State& state) {
  const render::Image drawn = WarmPainter(Carton().picture()).Draw(Carton().picture());
  render::Image golden = drawn;
  golden.rgb.front() ^= 1;
  for (auto _ : state) benchmark::DoNotOptimize(render::CompareImages(golden, drawn).pixels);
}
BENCHMARK(ComparePixels)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace prehend::bench
