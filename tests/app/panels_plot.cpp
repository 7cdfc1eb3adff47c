// Looking around in a plot with the mouse, and plots as PNG files.
#include "app/plot/colors.hpp"
#include "app/plot/csv.hpp"
#include "app/render/imgui_compat.hpp"
#include "app/render/offscreen.hpp"
#include "app/ui/app.hpp"
#include "app/ui/plots/plot_picture.hpp"
#include "app/ui/plots/plot_save.hpp"
#include "app/ui/snapshot.hpp"
#include "engine/mechanism/file.hpp"
#include "temporary_folder.hpp"
#include "tests/catch.hpp"

#include <imgui_internal.h>

#include <cmath>
#include <memory>

using namespace flyball;
using namespace flyball::test;

namespace {

Plot two_lines() {
  Plot plot;
  plot.title = "Test";
  plot.x = {.label = "speed", .unit = "rad/s", .range = PlotRange{0, 10}};
  plot.y = {.label = "angle", .unit = "rad", .range = PlotRange{0, 10}};
  plot.curves = {{"rising", {{0, 0}, {5, 5}, {10, 10}}}, {"level", {{0, 8}, {10, 8}}, PlotLine::dashed, 1}};
  return plot;
}

// A window with nothing but a plot, and the dialog that saves it; one change of input a frame.
struct Bench {
  App app{{.mode = LiveSolver::Mode::immediate,
           .on_news = {},
           .scenes = {},
           .theme = Theme::light,
           .numbers = {}}};
  PlotDialog dialog;
  std::unique_ptr<ImGuiContext, void (*)(ImGuiContext*)> context{ImGui::CreateContext(),
                                                                 ImGui::DestroyContext};
  Plot plot = two_lines();
  PlotView view;
  PlotEvents now;                        // of the last frame
  std::vector<PlotHit> clicked, dragged; // of all
  int ended = 0;
  int vertices = 0; // drawn in the last frame

  explicit Bench(float scale = 1) {
    ImGui::SetCurrentContext(context.get());
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = {900 * scale, 700 * scale};
    io.DeltaTime = 0.05f;
    imgui_compat::map_key(ImGuiKey_Enter, 257);
    imgui_compat::map_key(ImGuiKey_Escape, 256);
    imgui_compat::take_events_at_once();
    app.ui.scale = scale;
    app.ui.fonts = load_fonts(*io.Fonts, 16, scale);
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
    frame(3);
  }

  void frame(int count = 1) {
    for (int i = 0; i < count; ++i) {
      app.ui.widgets.clear();
      ImGui::NewFrame();
      ImGui::SetNextWindowPos({0, 0});
      ImGui::SetNextWindowSize(ImGui::GetIO().DisplaySize);
      ImGui::Begin("bench", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
      now = plot_view(app.session, app.ui, "test", view, plot, {600 * app.ui.scale, 400 * app.ui.scale});
      ImGui::Dummy({10, 2000 * app.ui.scale});
      ImGui::End();
      if (auto picture = dialog.draw(app.session, app.ui, app.dialog)) app.export_request = picture;
      ImGui::Render();
      vertices = ImGui::GetDrawData()->TotalVtxCount;
      ImGui::GetIO().MouseWheel = 0;
      if (now.clicked) clicked.push_back(*now.clicked);
      if (now.dragged_to) dragged.push_back(*now.dragged_to);
      ended += now.drag_ended;
    }
  }

  WidgetRect widget(const std::string& name) {
    const auto found = app.ui.widgets.find(name);
    INFO("widget " << name);
    REQUIRE(found != app.ui.widgets.end());
    return found->second;
  }
  // Where a value stands in the window.
  ImVec2 at(double x, double y) {
    const WidgetRect area = widget("plot/test/area");
    const PlotLayout& layout = *view.kept.layout;
    return {area.from.x + static_cast<float>(layout.x.pixel(x) - layout.area.left),
            area.from.y + static_cast<float>(layout.y.pixel(y) - layout.area.top)};
  }
  PlotRange range(int axis) {
    const PlotRuler& ruler = view.kept.layout->ruler(axis);
    return {ruler.lower, ruler.upper};
  }
  void point(ImVec2 p) {
    ImGui::GetIO().MousePos = p;
    frame(2);
  }
  void button(int which, bool down) {
    ImGui::GetIO().MouseDown[which] = down;
    frame();
  }
  void click(ImVec2 p, int which = 0) {
    point(p);
    button(which, true);
    button(which, false);
    frame(2);
  }
  void click(const std::string& name) { click(widget(name).center()); }
  void wheel(ImVec2 p, float notches) {
    point(p);
    ImGui::GetIO().MouseWheel = notches;
    frame(2);
  }
  void drag(ImVec2 from, ImVec2 to, int which = 0) {
    point(from);
    button(which, true);
    for (int i = 1; i <= 4; ++i) {
      const float t = static_cast<float>(i) / 4;
      point({from.x + t * (to.x - from.x), from.y + t * (to.y - from.y)});
    }
    button(which, false);
    frame(2);
  }
  // Over what is selected in the field that has the keyboard.
  void type(const std::string& text) {
    ImGui::GetIO().AddInputCharactersUTF8(text.c_str());
    frame(2);
  }
  void wait() { frame(12); } // longer than a double click
};

} // namespace

TEST_CASE("the wheel zooms a plot about the pointer, over an axis that axis alone") {
  Bench bench;
  bench.wheel(bench.at(2, 6), 3);
  const PlotRange x = bench.range(0), y = bench.range(1);
  CHECK(x[1] - x[0] < 7);
  CHECK(y[1] - y[0] == Approx(x[1] - x[0]));
  // What was under the pointer still is.
  CHECK((2 - x[0]) / (x[1] - x[0]) == Approx(0.2).margin(0.005));
  CHECK((6 - y[0]) / (y[1] - y[0]) == Approx(0.6).margin(0.005));

  bench.wheel(bench.widget("plot/test/axis/x").center(), -2);
  CHECK(bench.range(0)[1] - bench.range(0)[0] > 1.2 * (x[1] - x[0]));
  CHECK(bench.range(1) == y);

  SECTION("and a double click brings all back") {
    bench.wait();
    bench.point(bench.at(bench.range(0)[0] + 0.3, bench.range(1)[1] - 0.3));
    for (int i = 0; i < 4; ++i)
      bench.button(0, i % 2 == 0);
    bench.frame(2);
    CHECK(bench.range(0) == PlotRange{0, 10});
    CHECK(bench.range(1) == PlotRange{0, 10});
  }
}

TEST_CASE("a plot is panned with a drag") {
  Bench bench;
  SECTION("pan") {
    bench.drag(bench.at(3, 3), bench.at(5, 2));
    CHECK(bench.range(0)[0] == Approx(-2).margin(0.05));
    CHECK(bench.range(0)[1] == Approx(8).margin(0.05));
    CHECK(bench.range(1)[0] == Approx(1).margin(0.05));
    CHECK(bench.clicked.empty());
  }
  SECTION("pan of a logarithmic axis keeps its decades") {
    bench.plot.x.range = PlotRange{1, 100};
    bench.plot.x.logarithmic = true;
    bench.frame(2);
    bench.drag(bench.at(1.5, 3), bench.at(15, 3));
    CHECK(bench.range(0)[0] == Approx(0.1).epsilon(0.05));
    CHECK(bench.range(0)[1] == Approx(10).epsilon(0.05));
  }
}

TEST_CASE("a box is zoomed into by either gesture") {
  for (const bool shift : {false, true}) {
    Bench bench;
    imgui_compat::set_modifiers(false, shift);
    bench.drag(bench.at(2, 8), bench.at(4, 5), shift ? 0 : 1);
    CHECK(bench.range(0)[0] == Approx(2).margin(0.05));
    CHECK(bench.range(1)[1] == Approx(8).margin(0.05));
  }
}

TEST_CASE("the legend switches curves off and on") {
  Bench bench;
  bench.click("plot/test/legend/level");
  CHECK(bench.view.look.hidden == std::set<std::string>{"level"});
  CHECK(bench.view.kept.layout->curves.size() == 1);
  bench.click("plot/test/legend/level");
  CHECK(bench.view.look.hidden.empty());
  CHECK(bench.view.kept.layout->curves.size() == 2);
}

TEST_CASE("a plot tells which point is under the pointer, and which was clicked") {
  for (const float scale : {1.f, 2.f}) {
    Bench bench(scale);
    bench.point(bench.at(5.05, 5));
    REQUIRE(bench.now.hovered);
    CHECK(bench.now.hovered->curve == 0);
    CHECK(bench.now.hovered->index == 1);
    REQUIRE(bench.view.cursor);
    CHECK(*bench.view.cursor == Approx(5.05).margin(0.03));
    CHECK(bench.clicked.empty());
    bench.click(bench.at(5.05, 5));
    REQUIRE(bench.clicked.size() == 1);
    CHECK(bench.clicked[0].y == 5);
    bench.wait();
    bench.click(bench.at(2, 5)); // nothing there
    CHECK(bench.clicked.size() == 1);
    bench.point({2, 690 * scale});
    CHECK_FALSE(bench.view.cursor);
  }
}

TEST_CASE("the marker is dragged along the curves, and the plot stays") {
  Bench bench;
  bench.plot.marker = PlotMarker{2, 2, "now"};
  bench.view.look.hidden = {"level"};
  bench.frame(2);
  bench.drag(bench.at(2, 2), bench.at(7, 7));
  REQUIRE_FALSE(bench.dragged.empty());
  CHECK(bench.dragged.back().curve == 0);
  CHECK(bench.dragged.back().x == Approx(7).margin(0.05));
  CHECK(bench.dragged.back().index == Approx(1.4).margin(0.02));
  CHECK(bench.ended == 1);
  CHECK(bench.range(0) == PlotRange{0, 10});
}

TEST_CASE("the marker is not drawn over the card that reads the curves") {
  Bench bench;
  bench.plot.marker = PlotMarker{3, 3, "now"};
  bench.frame(2);
  const ImVec2 marker = bench.at(3, 3);
  bench.point({marker.x - 30, marker.y + 40}); // the card stands above the pointer, at the right
  // What is drawn last is the same with the marker and without: the card.
  const auto last = [&] {
    const ImDrawList* list = ImGui::FindWindowByName("bench")->DrawList;
    std::vector<float> at;
    for (int i = list->VtxBuffer.Size - 40; i < list->VtxBuffer.Size; ++i) {
      at.push_back(list->VtxBuffer[i].pos.x);
      at.push_back(list->VtxBuffer[i].pos.y);
    }
    return at;
  };
  const std::vector<float> with = last();
  bench.plot.marker.reset();
  bench.frame(2);
  CHECK(last() == with);
}

TEST_CASE("the menu offers scales, and the numbers for the clipboard") {
  Bench bench;
  static std::string clipboard;
  clipboard.clear();
  ImGui::GetIO().SetClipboardTextFn = [](void*, const char* text) { clipboard = text; };
  bench.click(bench.at(5, 2), 1);
  bench.click("plot/test/menu/log x");
  CHECK(bench.view.kept.layout->x.logarithmic);
  CHECK_FALSE(bench.view.kept.layout->y.logarithmic);
  bench.click(bench.at(5.5, 2), 1);
  bench.click("plot/test/menu/copy");
  CHECK(clipboard == to_csv(bench.plot));
}

TEST_CASE("what has not changed is not laid out again, and nothing is drawn out of sight") {
  Bench bench;
  bench.plot.version = 1;
  bench.frame(2);
  const PlotLayout* first = bench.view.kept.layout.get();
  bench.frame(3);
  CHECK(bench.view.kept.layout.get() == first);
  bench.plot.version = 2;
  bench.plot.curves.pop_back();
  bench.frame(1);
  CHECK(bench.view.kept.layout->curves.size() == 1);
  const int shown = bench.vertices;
  bench.wheel({850, 300}, -100); // the window scrolls beside the plot
  bench.frame(3);
  CHECK(bench.vertices < shown / 4);
}

TEST_CASE("the wheel over a plot does not scroll the panel") {
  Bench bench;
  const float before = bench.widget("plot/test/area").from.y;
  bench.wheel(bench.at(5, 2), -2);
  CHECK(bench.widget("plot/test/area").from.y == before);
}

TEST_CASE("a plot is saved as SVG, CSV and PNG through the dialog") {
  const OffscreenContext gl;
  const TemporaryFolder folder;
  Bench bench;
  for (const char* kind : {"svg", "csv", "png"}) {
    INFO(kind);
    bench.wait();
    bench.click(bench.at(5.5, 2), 1);
    bench.click(std::string("plot/test/menu/") + kind);
    bench.frame(2);
    const std::string file = (folder / (std::string("curve.") + kind)).string();
    bench.type(file);
    bench.click("save_plot/save");
    if (bench.app.export_request) export_picture(bench.app, {900, 700});
    CHECK(bench.app.session.notice == "Saved " + file);
    const std::string bytes = read_bytes(file);
    if (kind == std::string("csv")) CHECK(bytes == to_csv(bench.plot));
    if (kind == std::string("svg")) CHECK(bytes.starts_with("<svg"));
    if (kind == std::string("png")) CHECK(read_png(file).width == 1200);
  }
}

TEST_CASE("a plot's picture has its curves in their colours where they should be") {
  const OffscreenContext gl;
  Plot plot = two_lines();
  plot.curves[1].line = PlotLine::solid;
  for (const PlotGround ground : {PlotGround::light, PlotGround::dark, PlotGround::high_contrast})
    for (const float scale : {1.f, 2.f}) {
      const PixelSize size{static_cast<int>(600 * scale), static_cast<int>(400 * scale)};
      const Image image = draw_plot_picture(plot, {size, scale, ground});
      REQUIRE(image.width == size.width);
      const auto color_at = [&](int x, int y) {
        const std::uint8_t* p = image.at(x, y);
        return static_cast<std::uint32_t>(p[0] << 16 | p[1] << 8 | p[2]);
      };
      const auto near = [&](std::uint32_t a, std::uint32_t b) {
        for (int shift : {0, 8, 16})
          if (std::abs(static_cast<int>(a >> shift & 255) - static_cast<int>(b >> shift & 255)) > 40)
            return false;
        return true;
      };
      // The frame is found by its colour, from the middle outwards.
      const PlotColors& colors = plot_colors(ground);
      CHECK(near(color_at(1, 1), colors.page));
      int left = size.width / 2, right = left, top = size.height / 2, bottom = top;
      const auto frame_at = [&](int x, int y) { return near(color_at(x, y), colors.frame); };
      const int row = size.height * 6 / 10;
      while (left > 0 && !frame_at(left, row))
        --left;
      while (right < size.width - 1 && !frame_at(right, row))
        ++right;
      const int column = size.width * 4 / 10;
      while (top > 0 && !frame_at(column, top))
        --top;
      while (bottom < size.height - 1 && !frame_at(column, bottom))
        ++bottom;
      REQUIRE(right - left > size.width / 2);
      REQUIRE(bottom - top > size.height / 2);
      int found = 0;
      for (double value : {1.3, 3.3, 6.3}) {
        const int x = left + static_cast<int>(value / 10 * (right - left));
        for (const auto& [y_value, curve] : {std::pair{value, 0}, std::pair{8., 1}}) {
          const int y = bottom - static_cast<int>(std::lround(y_value / 10 * (bottom - top)));
          bool there = false;
          for (int d = -2; d <= 2; ++d)
            there = there || near(color_at(x, y + d), curve_color(curve, ground));
          found += there;
        }
      }
      CHECK(found == 6);
    }
  CHECK(ImGui::GetCurrentContext() == nullptr);
}
