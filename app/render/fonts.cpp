#include "app/render/fonts.hpp"

#include "app/platform/data_folder.hpp"
#include "app/platform/font_folders.hpp"
#include "app/render/icons.hpp"

#include <cmath>
#include <filesystem>
#include <initializer_list>

namespace flyball {

namespace {

// Latin, Greek, punctuation, superscripts, arrows, mathematics and the check mark.
constexpr ImWchar text_ranges[] = {0x0020, 0x017F, 0x0370, 0x03FF, 0x2010, 0x2027, 0x2030,
                                   0x205E, 0x2070, 0x209C, 0x2190, 0x21FF, 0x2200, 0x22FF,
                                   0x25A0, 0x25FF, 0x2713, 0x2717, 0};
constexpr ImWchar icon_ranges[] = {icon::first, icon::last, 0};

// Those installed with the program, else where distributions keep the packages' fonts.
std::string find_font(std::initializer_list<const char*> names) {
  std::vector<std::filesystem::path> folders = font_folders();
  folders.insert(folders.begin(), data_folder() / "fonts");
  std::error_code ignored;
  for (const char* name : names)
    for (const std::filesystem::path& folder : folders)
      if (std::filesystem::exists(folder / name, ignored)) return (folder / name).string();
  return {};
}

struct Wish {
  const char* name;
  std::initializer_list<const char*> files; // the best first, fallbacks after it
};

ImFont* load(ImFontAtlas& atlas, const Wish& wish, float pixels, const std::string& icons, UiFonts& fonts) {
  const std::string file = find_font(wish.files);
  if (file.empty() || file.find("DejaVu") != std::string::npos) fonts.missing.emplace_back(wish.name);
  ImFontConfig config;
  config.OversampleH = 2;
  config.OversampleV = 1;
  ImFont* font = nullptr;
  if (!file.empty()) {
    font = atlas.AddFontFromFileTTF(file.c_str(), pixels, &config, text_ranges);
    fonts.files.push_back(file);
  }
  if (!font) {
    config.SizePixels = pixels;
    font = atlas.AddFontDefault(&config);
  }
  if (!icons.empty()) {
    ImFontConfig merge;
    merge.MergeMode = true;
    merge.PixelSnapH = true;
    merge.GlyphMinAdvanceX = pixels; // icons stand in a column of their own width
    merge.GlyphOffset.y = std::round(0.04f * pixels);
    atlas.AddFontFromFileTTF(icons.c_str(), std::round(0.9f * pixels), &merge, icon_ranges);
  }
  return font;
}

} // namespace

UiFonts load_fonts(ImFontAtlas& atlas, float size, float scale) {
  atlas.Clear();
  UiFonts fonts;
  const float pixels = std::round(size * scale);
  const std::string icons = find_font({"fontawesome-webfont.ttf"});
  if (icons.empty())
    fonts.missing.emplace_back("Font Awesome");
  else
    fonts.files.push_back(icons);
  fonts.text = load(atlas, {"Inter", {"Inter-Regular.otf", "Inter-Regular.ttf", "DejaVuSans.ttf"}}, pixels,
                    icons, fonts);
  fonts.strong =
      load(atlas, {"Inter semibold", {"Inter-SemiBold.otf", "Inter-SemiBold.ttf", "DejaVuSans-Bold.ttf"}},
           pixels, icons, fonts);
  fonts.digits = load(atlas, {"JetBrains Mono", {"JetBrainsMono-Regular.ttf", "DejaVuSansMono.ttf"}},
                      std::round(1.04f * pixels), icons, fonts);
  return fonts;
}

} // namespace flyball
