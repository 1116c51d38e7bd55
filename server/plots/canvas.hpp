#pragma once

#include <memory>
#include <string>

#include "server/plots/draw.hpp"

typedef struct _cairo cairo_t;

namespace kinectlab::plots {

struct Colour {
    double r = 0.0, g = 0.0, b = 0.0;
};

inline constexpr Colour kInk{0.13, 0.15, 0.18};
inline constexpr Colour kFaint{0.87, 0.89, 0.91};

/// The i-th colour of curves: apart from each other also for colour-blind readers (Okabe and Ito).
[[nodiscard]] Colour curve_colour(std::size_t i);

enum class Align { left, centre, right };

/// A white sheet to draw on in points; y goes down.
class Canvas {
public:
    Canvas(double width, double height, Format format);
    ~Canvas();
    Canvas(const Canvas&) = delete;
    Canvas& operator=(const Canvas&) = delete;

    void line(double x0, double y0, double x1, double y1, Colour colour, double width = 1.0);
    void dot(double x, double y, double radius, Colour colour);
    void box(double x, double y, double width, double height, Colour colour);
    void text(
        double x,
        double y,
        const std::string& words,
        Align align,
        double size = 12.0,
        bool upright = false
    );
    [[nodiscard]] double text_width(const std::string& words, double size = 12.0);
    /// What is drawn until the next call stays inside.
    void clip(double x, double y, double width, double height);
    void unclip();
    /// A curve: move_to begins a piece, stroke draws all pieces.
    void move_to(double x, double y);
    void line_to(double x, double y);
    void stroke(Colour colour, double width);

    /// The picture's bytes; nothing may be drawn after.
    [[nodiscard]] std::string finish();

private:
    struct Surface;
    std::unique_ptr<Surface> surface_;
    cairo_t* cairo_;
};

}  // namespace kinectlab::plots
