// Several views in one recording: the order of their commands, and what is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "frame_fixture.h"
#include "null_device.h"
#include "pellucid/pellucid_views.h"

namespace {

using namespace pellucid::test;

VkImageView handle(uint64_t number) { return reinterpret_cast<VkImageView>(uintptr_t{number}); }
uint64_t number(VkImageView view) { return reinterpret_cast<uintptr_t>(view); }

// A frame with images of its own, and a slice of the buffer that all share.
struct View {
  Frame f;
  PellucidPlan plan{};
  std::vector<unsigned char> memory;
  PellucidConstantsSlice slice{};

  View(uint32_t index, void (*change)(Frame&)) : index_(index) {
    PellucidFrame& p = f.frame;
    uint64_t next = kImages * index;
    for (PellucidImage* image : {&p.frontDepth, &p.backDepth, &p.irradiance, &p.material, &p.output})
      image->view = handle(++next);
    for (PellucidImage& image : p.transients) image = {handle(++next), VK_IMAGE_LAYOUT_GENERAL};
    p.options.history = {handle(++next), VK_IMAGE_LAYOUT_GENERAL};
    change(f);
    makePlan(nullptr);
  }

  void makePlan(const PellucidPlan* previous) {
    ASSERT_EQ(pellucidBuildPlan(&f.frame, previous, &plan), PELLUCID_OK) << f.problems();
    ASSERT_LE(plan.constantsSize, kSliceBytes);
    memory.resize(plan.constantsSize);
    slice = {reinterpret_cast<VkBuffer>(uintptr_t{7}), kSliceBytes * index_, plan.constantsSize,
             memory.data()};
  }

  PellucidView get() const { return {&plan, &f.frame, &slice}; }

  static constexpr uint64_t kImages = 100;  // handles of one view
  static constexpr VkDeviceSize kSliceBytes = 262144;

private:
  uint32_t index_;
};

class Views : public testing::Test {
protected:
  void SetUp() override {
    PellucidContextDesc desc = device_.desc();
    desc.messageUser = &said_;
    desc.message = [](void* user, PellucidSeverity, const char* field, const char* message) {
      *static_cast<std::string*>(user) += std::string(field) + " " + message + "\n";
    };
    ASSERT_EQ(pellucidCreateContext(&desc, &context_), PELLUCID_OK);
  }
  void TearDown() override { pellucidDestroyContext(context_); }

  static NullCommands commandsFor(size_t views) {
    NullCommands commands;
    commands.sliceSize = View::kSliceBytes * views;
    return commands;
  }
  PellucidResult record(NullCommands& commands, const std::vector<PellucidView>& views) {
    said_.clear();
    return pellucidRecordViews(context_, commands.handle(), static_cast<uint32_t>(views.size()),
                               views.data());
  }

  // After the context.
  NullDevice device_;
  PellucidContext* context_ = nullptr;
  std::string said_;
};

void noLists(Frame& f) { f.frame.options.gatherSamples = 8; }
void wholeFrame(Frame& f) {
  noLists(f);
  f.frame.options.indirectDispatches = 1;
}
void noGather(Frame& f) { f.frame.options.gatherSamples = 0; }
void translucencyAlone(Frame& f) { f.frame.options.features = PELLUCID_FEATURE_TRANSLUCENCY; }
void nothing(Frame& f) {
  f.frame.options.features = 0;
  f.frame.output = f.frame.irradiance;
}
void reusing(Frame& f) {
  wholeFrame(f);
  f.frame.options.reuse = PELLUCID_REUSE_ALTERNATE;
}
void smaller(Frame& f) {
  wholeFrame(f);
  f.frame.imageExtent[0] = 20;
  f.frame.imageExtent[1] = 10;
}

constexpr void (*kKinds[])(Frame&) = {wholeFrame, noLists, noGather, translucencyAlone,
                                      nothing,    reusing, smaller};

// The commands that one view has among those of a recording, with the barriers before each dispatch in it.
void expectCommandsOf(const View& view, const std::vector<NullCommand>& commands, uint64_t index) {
  uint32_t barriers = 0, dispatch = 0, ownBarriers = 0;
  for (const NullCommand& c : commands) {
    if (c.barrier) ++barriers;
    if (c.barrier || (number(c.image) - 1) / View::kImages != index) continue;
    ASSERT_LT(dispatch, view.plan.dispatchCount);
    const PellucidDispatch& d = view.plan.dispatches[dispatch++];
    ownBarriers += d.barrierBefore;
    EXPECT_EQ(barriers, ownBarriers) << d.name;
    EXPECT_EQ(c.indirect, d.indirect != 0) << d.name;
    if (!d.barrierBefore || !d.barrierIndirect) continue;
    uint32_t nth = 0;
    for (const NullCommand& b : commands)
      if (b.barrier && ++nth == barriers) {
        EXPECT_TRUE(b.indirect) << d.name;
      }
  }
  EXPECT_EQ(dispatch, view.plan.dispatchCount);
}

TEST_F(Views, ShareBarriersAndKeepTheOrderOfEachPlan) {
  std::set<uint32_t> lengths;
  for (void (*first)(Frame&) : kKinds)
    for (void (*second)(Frame&) : kKinds) {
      const View views[] = {{0, first}, {1, second}, {2, wholeFrame}};
      NullCommands commands = commandsFor(std::size(views));
      ASSERT_EQ(record(commands, {views[0].get(), views[1].get(), views[2].get()}), PELLUCID_OK) << said_;
      EXPECT_EQ(commands.problem, "");
      uint32_t dispatches = 0, barriers = 0;
      for (size_t i = 0; i < std::size(views); ++i) {
        dispatches += views[i].plan.dispatchCount;
        barriers = std::max(barriers, views[i].plan.barrierCount);
        expectCommandsOf(views[i], commands.commands, i);
        lengths.insert(views[i].plan.barrierCount);
      }
      EXPECT_EQ(commands.dispatches, dispatches);
      EXPECT_EQ(commands.barriers, barriers);
    }
  EXPECT_GE(lengths.size(), 3u) << "the plans are too much alike for this test";
}

TEST_F(Views, OneIsARecordingOfItsPlan) {
  for (void (*kind)(Frame&) : kKinds) {
    View view(0, kind);
    for (const bool reused : {false, true}) {
      if (reused) {
        const PellucidPlan previous = view.plan;
        view.makePlan(&previous);
      }
      NullCommands alone = commandsFor(1), viewed = commandsFor(1);
      ASSERT_EQ(pellucidRecordPlan(context_, alone.handle(), &view.plan, &view.f.frame, &view.slice),
                PELLUCID_OK);
      const std::vector<unsigned char> constants = view.memory;
      ASSERT_EQ(record(viewed, {view.get()}), PELLUCID_OK) << said_;
      EXPECT_EQ(alone.commands, viewed.commands);
      EXPECT_EQ(alone.barriers, view.plan.barrierCount);
      EXPECT_EQ(constants, view.memory) << "recording writes no constants";
    }
  }
}

TEST_F(Views, NoneAreRecordedWithoutACommand) {
  NullCommands commands = commandsFor(0);
  EXPECT_EQ(pellucidRecordViews(context_, commands.handle(), 0, nullptr), PELLUCID_OK);
  EXPECT_EQ(pellucidRecordViews(context_, commands.handle(), 1, nullptr), PELLUCID_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(pellucidRecordViews(nullptr, commands.handle(), 0, nullptr), PELLUCID_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(pellucidRecordViews(context_, nullptr, 0, nullptr), PELLUCID_ERROR_INVALID_ARGUMENT);
  EXPECT_TRUE(commands.commands.empty());
}

// ---- Refusals

struct Refusal {
  const char* name;
  void (*change)(View& a, View& b, PellucidView (&views)[2]);
  const char* words;
  PellucidResult result = PELLUCID_ERROR_INVALID_ARGUMENT;
};

void halves(View& a, View& b) {
  const uint32_t left[4] = {0, 0, 50, 50}, right[4] = {50, 0, 50, 50};
  std::copy(left, left + 4, a.f.frame.options.renderRect);
  std::copy(right, right + 4, b.f.frame.options.renderRect);
  a.makePlan(nullptr);
  b.makePlan(nullptr);
}

const Refusal kRefusals[] = {
    {"OneTransientForTwo", [](View& a, View& b, auto&) { b.f.frame.transients[1] = a.f.frame.transients[0]; },
     "views[1].transients[1] is views[0].transients[0], too"},
    {"OneTransientForTwoHalves",
     [](View& a, View& b, auto&) {
       halves(a, b);
       b.f.frame.transients[0] = a.f.frame.transients[0];
     },
     "views[1].transients[0] is views[0].transients[0], too"},
    {"OneOutput", [](View& a, View& b, auto&) { b.f.frame.output = a.f.frame.output; },
     "views[1].output is views[0].output, too"},
    {"OneOutputWithRectsThatMeet",
     [](View& a, View& b, auto&) {
       halves(a, b);
       ++a.f.frame.options.renderRect[2];
       a.makePlan(nullptr);
       b.f.frame.output = a.f.frame.output;
     },
     "views[1].output is views[0].output, too"},
    {"OutputThatIsAnInput", [](View& a, View& b, auto&) { a.f.frame.output = b.f.frame.irradiance; },
     "views[1].irradiance is views[0].output, too"},
    {"InPlaceByAPlanOfTwoImages", [](View& a, View&, auto&) { a.f.frame.output = a.f.frame.irradiance; },
     "views[0].output is the irradiance's view"},
    {"ShadowImageThatIsTheOtherOutput", [](View& a, View& b, auto&) { b.f.images[0] = a.f.frame.output; },
     "views[1].shadowImages[0] is views[0].output, too"},
    {"OutputThatIsTheOtherShadowImage", [](View& a, View& b, auto&) { b.f.frame.output = a.f.images[0] = {handle(90), VK_IMAGE_LAYOUT_GENERAL}; },
     "views[1].output is views[0].shadowImages[0], too"},
    {"InputThatIsATransient", [](View& a, View& b, auto&) { b.f.frame.backDepth = a.f.frame.transients[0]; },
     "views[1].backDepth is views[0].transients[0], too"},
    {"OneHistory",
     [](View& a, View& b, auto&) {
       for (View* v : {&a, &b}) {
         v->f.frame.options.reuse = PELLUCID_REUSE_ALTERNATE;
         v->makePlan(nullptr);
       }
       b.f.frame.options.history = a.f.frame.options.history;
     },
     "views[1].options.history is views[0].options.history, too"},
    {"OneSlice", [](View& a, View&, auto& views) { views[1].constants = &a.slice; },
     "views[1].constants.offset is 0 for"},
    {"SlicesThatOverlap", [](View&, View& b, auto&) { b.slice.offset = 256; },
     "views[1].constants.offset is 256 for"},
    {"OneAddress", [](View& a, View& b, auto&) { b.slice.mapped = a.slice.mapped; },
     "views[1].constants.mapped overlaps the bytes of views[0].constants.mapped"},
    {"NoPlan", [](View&, View&, auto& views) { views[1].plan = nullptr; }, "views[1].plan is NULL"},
    {"NoFrame", [](View&, View&, auto& views) { views[0].frame = nullptr; }, "views[0].frame is NULL"},
    {"NoConstants", [](View&, View&, auto& views) { views[1].constants = nullptr; },
     "views[1].constants is NULL"},
    {"UnalignedSlice", [](View&, View& b, auto&) { b.slice.offset += 16; },
     "views[1].constants needs a buffer and an offset that is a multiple of 256"},
    {"SmallSlice", [](View&, View& b, auto&) { b.slice.size = 256; },
     "views[1].constants.size is 256; the plan needs", PELLUCID_ERROR_BUFFER_TOO_SMALL},
    {"PlanOfTheOtherView", [](View&, View& b, auto&) { b.f.frame.shadowImageCount = 0; },
     "views[1].shadowImages[0] has no view, but the plan binds it"},
    {"MoreDispatchesThanAPlanHolds", [](View&, View& b, auto&) { b.plan.dispatchCount = 33; },
     "views[1].plan has 33 dispatches; needs at most 32"},
    {"NoView", [](View&, View& b, auto&) { b.f.frame.material = {}; }, "views[1].material has no view"}};

TEST_F(Views, RefusalsNameTheViewAndRecordNothing) {
  for (const Refusal& refusal : kRefusals) {
    SCOPED_TRACE(refusal.name);
    View a(0, wholeFrame), b(1, wholeFrame);
    PellucidView views[] = {a.get(), b.get()};
    refusal.change(a, b, views);
    NullCommands commands = commandsFor(2);
    EXPECT_EQ(record(commands, {views[0], views[1]}), refusal.result);
    EXPECT_TRUE(said_.starts_with(refusal.words)) << said_;
    EXPECT_TRUE(commands.commands.empty());
  }
}

// ---- What views may share

TEST_F(Views, ShareInputsAndDisjointPartsOfOutputs) {
  View a(0, wholeFrame), b(1, wholeFrame);
  NullCommands inputs = commandsFor(2);
  b.f.frame.frontDepth = a.f.frame.frontDepth;
  b.f.frame.backDepth = a.f.frame.backDepth;
  b.f.frame.material = a.f.frame.material;
  EXPECT_EQ(record(inputs, {a.get(), b.get()}), PELLUCID_OK) << said_;
  b.f.frame.irradiance = a.f.frame.irradiance;
  EXPECT_EQ(record(inputs, {a.get(), b.get()}), PELLUCID_OK) << said_;

  halves(a, b);
  b.f.frame.output = a.f.frame.output;
  EXPECT_EQ(record(inputs, {a.get(), b.get()}), PELLUCID_OK) << said_;
  for (View* v : {&a, &b}) {
    v->f.frame.output = a.f.frame.irradiance;
    v->makePlan(nullptr);
  }
  EXPECT_EQ(record(inputs, {a.get(), b.get()}), PELLUCID_OK) << said_;
  EXPECT_EQ(inputs.problem, "");
}

// A view's transients beyond those that its frame needs may hold anything, and slices end where plans do.
TEST_F(Views, WhatPlansDoNotUseMayBeEqual) {
  View a(0, translucencyAlone), b(1, translucencyAlone);
  std::copy(std::begin(a.f.frame.transients), std::end(a.f.frame.transients), b.f.frame.transients);
  b.f.frame.options.history = a.f.frame.options.history;
  a.slice.size = 2 * View::kSliceBytes;
  NullCommands commands = commandsFor(2);
  EXPECT_EQ(record(commands, {a.get(), b.get()}), PELLUCID_OK) << said_;
  EXPECT_EQ(commands.problem, "");
}

}  // namespace
