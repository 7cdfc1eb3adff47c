// Icons of Font Awesome 4 as UTF-8, merged into every font load_fonts gives.
#pragma once

namespace flyball::icon {

inline constexpr unsigned short first = 0xF000, last = 0xF2E0;

inline constexpr char check[] = "\uF00C";
inline constexpr char close[] = "\uF00D";
inline constexpr char gear[] = "\uF013";
inline constexpr char file[] = "\uF016";
inline constexpr char refresh[] = "\uF021";
inline constexpr char lock[] = "\uF023";
inline constexpr char camera[] = "\uF030";
inline constexpr char step_backward[] = "\uF048";
inline constexpr char play[] = "\uF04B";
inline constexpr char pause[] = "\uF04C";
inline constexpr char chevron_left[] = "\uF053";
inline constexpr char chevron_right[] = "\uF054";
inline constexpr char eye[] = "\uF06E";
inline constexpr char eye_off[] = "\uF070";
inline constexpr char warning[] = "\uF071";
inline constexpr char folder_open[] = "\uF07C";
inline constexpr char folder[] = "\uF114";
inline constexpr char folder_up[] = "\uF148";
inline constexpr char save[] = "\uF0C7";
inline constexpr char undo[] = "\uF0E2";
inline constexpr char expand[] = "\uF065";
inline constexpr char info[] = "\uF05A";
inline constexpr char question[] = "\uF059";
inline constexpr char trash[] = "\uF1F8";
inline constexpr char redo[] = "\uF01E";
inline constexpr char sun[] = "\uF185";
inline constexpr char moon[] = "\uF186";
inline constexpr char pin[] = "\uF08D";
inline constexpr char swap[] = "\uF0EC";

} // namespace flyball::icon
