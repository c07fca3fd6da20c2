#include "line_plot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace meniscus::benchmarks {
namespace {

// Pixels.
constexpr double width = 760.0;
constexpr double height = 340.0;
constexpr double left = 62.0;
constexpr double right = 570.0;
constexpr double top = 34.0;
constexpr double bottom = 292.0;
constexpr double legend_row = 20.0;

constexpr const char* ink = "#7d858e";
constexpr std::array<const char*, 9> colors{"#3b82f6", "#f07030", "#22a35a", "#b065e0", "#d49a1f",
                                            "#e5508a", "#1fb0b8", "#9a7b5f", "#8d96a0"};

/// One axis: values from `low` to `high` over pixels from `first` to `last`, with a tick every `step`.
struct Axis {
    double low;
    double high;
    double first;
    double last;
    double step;

    double pixel(double value) const { return first + (value - low) / (high - low) * (last - first); }
};

/// 1, 2 or 5 times a power of ten, so that about five steps cover the range.
double round_step(double range) {
    const double power = std::pow(10.0, std::floor(std::log10(range / 5.0)));
    for (const double factor : {1.0, 2.0, 5.0})
        if (range <= 6.0 * factor * power) return factor * power;
    return 10.0 * power;
}

Axis x_axis(const std::vector<double>& x) {
    const double low = x.empty() ? 0.0 : x.front();
    const double high = x.empty() || x.back() <= low ? low + 1.0 : x.back();
    return {low, high, left, right, round_step(high - low)};
}

Axis y_axis(const std::vector<Line>& lines) {
    double high = 0.0;
    for (const Line& line : lines)
        for (const double value : line.values) high = std::max(high, value);
    if (high <= 0.0) high = 1.0;
    const double step = round_step(high);
    return {0.0, std::ceil(high / step) * step, bottom, top, step};
}

void draw_text(std::ostream& out, double x, double y, const char* anchor, const std::string& text) {
    out << "<text x=\"" << x << "\" y=\"" << y << "\" text-anchor=\"" << anchor << "\">" << text << "</text>\n";
}

void draw_segment(std::ostream& out, double x0, double y0, double x1, double y1, const char* style) {
    out << "<path d=\"M" << x0 << ' ' << y0 << 'L' << x1 << ' ' << y1 << "\" " << style << "/>\n";
}

std::string tick_label(double value) {
    std::ostringstream out;
    out << std::setprecision(6) << (std::abs(value) < 1e-12 ? 0.0 : value);
    return out.str();
}

void draw_axes(std::ostream& out, const LinePlot& plot, const Axis& x, const Axis& y) {
    const std::string stroke = std::string("stroke=\"") + ink + "\"";
    const std::string grid = stroke + " stroke-opacity=\"0.3\"";
    for (int i = 0; i * y.step <= y.high * (1.0 + 1e-9); ++i) {
        const double pixel = y.pixel(i * y.step);
        draw_segment(out, left, pixel, right, pixel, grid.c_str());
        draw_text(out, left - 7.0, pixel + 4.0, "end", tick_label(i * y.step));
    }
    for (auto i = static_cast<int>(std::ceil(x.low / x.step)); i * x.step <= x.high * (1.0 + 1e-9); ++i) {
        const double pixel = x.pixel(i * x.step);
        draw_segment(out, pixel, bottom, pixel, bottom + 5.0, stroke.c_str());
        draw_text(out, pixel, bottom + 19.0, "middle", tick_label(i * x.step));
    }
    draw_segment(out, left, bottom, right, bottom, stroke.c_str());
    draw_text(out, 0.5 * (left + right), bottom + 39.0, "middle", plot.x_label);
    out << "<text transform=\"translate(16 " << 0.5 * (top + bottom) << ") rotate(-90)\" text-anchor=\"middle\">"
        << plot.y_label << "</text>\n";
    out << "<text x=\"" << left << "\" y=\"18\" font-size=\"15\">" << plot.title << "</text>\n";
}

void draw_line(std::ostream& out, const std::vector<double>& xs, const Line& line, const char* color, const Axis& x,
               const Axis& y) {
    out << "<polyline fill=\"none\" stroke-width=\"1.6\" stroke-linejoin=\"round\" stroke=\"" << color
        << "\" points=\"";
    for (std::size_t i = 0; i < xs.size(); ++i)
        out << (i == 0 ? "" : " ") << x.pixel(xs[i]) << ',' << y.pixel(line.values[i]);
    out << "\"/>\n";
}

}  // namespace

std::string to_svg(const LinePlot& plot) {
    std::ostringstream out;
    out << std::fixed << std::setprecision(1);
    out << "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " << width << ' ' << height << "\" width=\""
        << width << "\" height=\"" << height << "\" font-family=\"sans-serif\" font-size=\"13\" fill=\"" << ink
        << "\">\n";
    const Axis x = x_axis(plot.x);
    const Axis y = y_axis(plot.lines);
    draw_axes(out, plot, x, y);
    for (std::size_t i = 0; i < plot.lines.size(); ++i) {
        const char* color = colors[i % colors.size()];
        draw_line(out, plot.x, plot.lines[i], color, x, y);
        const double row = top + 8.0 + legend_row * static_cast<double>(i);
        const std::string style = std::string("stroke-width=\"3\" stroke=\"") + color + "\"";
        draw_segment(out, right + 16.0, row, right + 38.0, row, style.c_str());
        draw_text(out, right + 45.0, row + 4.5, "start", plot.lines[i].name);
    }
    out << "</svg>\n";
    return out.str();
}

}  // namespace meniscus::benchmarks
