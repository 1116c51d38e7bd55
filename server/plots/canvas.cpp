#include "server/plots/canvas.hpp"

#include <array>
#include <numbers>
#include <stdexcept>

#include <cairo-svg.h>
#include <cairo.h>

namespace kinectlab::plots {
namespace {

constexpr double kPngScale = 2.0;

cairo_status_t append(void* to, const unsigned char* bytes, unsigned int n) {
    static_cast<std::string*>(to)->append(reinterpret_cast<const char*>(bytes), n);
    return CAIRO_STATUS_SUCCESS;
}

}  // namespace

struct Canvas::Surface {
    Format format;
    std::string bytes;
    cairo_surface_t* surface = nullptr;
};

Colour curve_colour(std::size_t i) {
    static constexpr std::array<Colour, 6> kColours{
        {{0.00, 0.45, 0.70},
         {0.84, 0.37, 0.00},
         {0.00, 0.62, 0.45},
         {0.80, 0.47, 0.65},
         {0.90, 0.62, 0.00},
         {0.34, 0.71, 0.91}}};
    return kColours[i % kColours.size()];
}

Canvas::Canvas(double width, double height, Format format) : surface_(std::make_unique<Surface>()) {
    surface_->format = format;
    if (format == Format::svg) {
        surface_->surface =
            cairo_svg_surface_create_for_stream(append, &surface_->bytes, width, height);
        cairo_svg_surface_restrict_to_version(surface_->surface, CAIRO_SVG_VERSION_1_2);
    } else {
        surface_->surface = cairo_image_surface_create(
            CAIRO_FORMAT_RGB24,
            static_cast<int>(width * kPngScale),
            static_cast<int>(height * kPngScale)
        );
    }
    cairo_ = cairo_create(surface_->surface);
    if (cairo_status(cairo_) != CAIRO_STATUS_SUCCESS)
        throw std::runtime_error("cairo cannot make a picture");
    if (format == Format::png) cairo_scale(cairo_, kPngScale, kPngScale);
    cairo_select_font_face(
        cairo_, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL
    );
    box(0.0, 0.0, width, height, {1.0, 1.0, 1.0});
}

Canvas::~Canvas() {
    cairo_destroy(cairo_);
    cairo_surface_destroy(surface_->surface);
}

void Canvas::line(double x0, double y0, double x1, double y1, Colour colour, double width) {
    move_to(x0, y0);
    line_to(x1, y1);
    stroke(colour, width);
}

void Canvas::dot(double x, double y, double radius, Colour colour) {
    cairo_set_source_rgba(cairo_, colour.r, colour.g, colour.b, 0.7);
    cairo_new_path(cairo_);
    cairo_arc(cairo_, x, y, radius, 0.0, 2.0 * std::numbers::pi);
    cairo_fill(cairo_);
}

void Canvas::box(double x, double y, double width, double height, Colour colour) {
    cairo_set_source_rgb(cairo_, colour.r, colour.g, colour.b);
    cairo_rectangle(cairo_, x, y, width, height);
    cairo_fill(cairo_);
}

void Canvas::text(
    double x, double y, const std::string& words, Align align, double size, bool upright
) {
    const double width = text_width(words, size);
    const double back = align == Align::left ? 0.0 : align == Align::right ? width : width / 2.0;
    cairo_save(cairo_);
    cairo_set_source_rgb(cairo_, kInk.r, kInk.g, kInk.b);
    cairo_translate(cairo_, x, y);
    if (upright) cairo_rotate(cairo_, -std::numbers::pi / 2.0);
    cairo_move_to(cairo_, -back, 0.0);
    cairo_show_text(cairo_, words.c_str());
    cairo_restore(cairo_);
}

double Canvas::text_width(const std::string& words, double size) {
    cairo_set_font_size(cairo_, size);
    cairo_text_extents_t extents;
    cairo_text_extents(cairo_, words.c_str(), &extents);
    return extents.x_advance;
}

void Canvas::clip(double x, double y, double width, double height) {
    cairo_save(cairo_);
    cairo_rectangle(cairo_, x, y, width, height);
    cairo_clip(cairo_);
}

void Canvas::unclip() {
    cairo_restore(cairo_);
}

void Canvas::move_to(double x, double y) {
    cairo_move_to(cairo_, x, y);
}

void Canvas::line_to(double x, double y) {
    cairo_line_to(cairo_, x, y);
}

void Canvas::stroke(Colour colour, double width) {
    cairo_set_source_rgb(cairo_, colour.r, colour.g, colour.b);
    cairo_set_line_width(cairo_, width);
    cairo_set_line_join(cairo_, CAIRO_LINE_JOIN_ROUND);
    cairo_stroke(cairo_);
}

std::string Canvas::finish() {
    cairo_surface_flush(surface_->surface);
    if (surface_->format == Format::png)
        cairo_surface_write_to_png_stream(surface_->surface, append, &surface_->bytes);
    else
        cairo_surface_finish(surface_->surface);
    return std::move(surface_->bytes);
}

}  // namespace kinectlab::plots
