// Where the tables come from: client/web/src/color/color_maps.ts, which has the same.
#include "picture/color_maps.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace meniscus::cli {
namespace {

constexpr std::size_t stops = 52;

constexpr std::string_view table(ColorMap map) {
    switch (map) {
        case ColorMap::viridis:
            return "440154 46085c 471063 481769 481d6f 482475 472a7a 46307e 453781 433d84 "
                   "414287 3f4889 3d4e8a 3a538b 38598c 355e8d 33638d 31688e 2e6d8e 2c718e "
                   "2a768e 297b8e 27808e 25848e 23898e 218e8d 20928c 1f978b 1e9c89 1fa188 "
                   "21a585 24aa83 28ae80 2eb37c 35b779 3dbc74 46c06f 50c46a 5ac864 65cb5e "
                   "70cf57 7cd250 89d548 95d840 a2da37 b0dd2f bddf26 cae11f d8e219 e5e419 "
                   "f1e51d fde725";
        case ColorMap::magma:
            return "000004 02020b 050416 090720 0e0b2b 140e36 1a1042 21114e 29115a 311165 "
                   "390f6e 420f75 4a1079 52137c 5a167e 621980 6a1c81 721f81 792282 812581 "
                   "892881 912b81 992d80 a1307e aa337d b2357b ba3878 c23b75 ca3e72 d2426f "
                   "d9466b e04c67 e75263 ec5860 f1605d f4695c f7725c f97b5d fb8560 fc8e64 "
                   "fd9869 fea16e feaa74 feb47b febd82 fec68a fecf92 fed89a fde2a3 fdebac "
                   "fcf4b6 fcfdbf";
        case ColorMap::plasma:
            return "0d0887 1b068d 260591 2f0596 38049a 41049d 4903a0 5102a3 5901a5 6100a7 "
                   "6900a8 7100a8 7801a8 8004a8 8707a6 8e0ca4 9511a1 9c179e a21d9a a82296 "
                   "ae2892 b42e8d ba3388 bf3984 c43e7f c9447a cd4a76 d24f71 d6556d da5b69 "
                   "de6164 e26660 e66c5c e97257 ed7953 f07f4f f3854b f58c46 f79342 f99a3e "
                   "fba139 fca835 fdaf31 feb72d febe2a fdc627 fcce25 fbd724 f8df25 f6e826 "
                   "f3f027 f0f921";
        case ColorMap::cividis:
            return "00204d 002455 00275e 002b67 002e6f 00316f 00356e 12386d 1f3c6d 28406c "
                   "30436c 36476b 3d4a6b 424e6b 48526b 4d556c 52596c 575c6d 5b606e 60646f "
                   "646770 696b71 6d6e72 727274 767676 7a7a78 7f7d78 848179 888579 8d8979 "
                   "928d78 979178 9c9577 a19976 a69d75 aca174 b1a573 b6a971 bbae6f c1b26d "
                   "c6b66b ccbb69 d1bf66 d7c463 dcc860 e2cd5c e8d259 edd654 f3db4f f9e04a "
                   "ffe544 ffea46";
        case ColorMap::coolwarm:
            return "3b4cc0 4155c8 475dcf 4d66d6 536edd 5977e2 5f7fe8 6687ed 6d8ef1 7396f5 "
                   "7a9df8 81a4fb 88abfd 8fb1fe 96b7ff 9dbdff a3c2fe aac7fd b1cbfc b7cff9 "
                   "bed3f6 c4d6f3 cad8ef d0daea d5dbe5 dadce0 dfdcd9 e5d9d2 e9d6cb edd2c3 "
                   "f0cebc f3c9b4 f5c4ac f6bea4 f7b89c f7b294 f7ab8c f6a385 f59c7d f39475 "
                   "f08b6e ed8366 ea7a5f e57058 e16751 dc5d4a d65243 d0473d ca3b37 c32e31 "
                   "bc1e2b b40426";
    }
    return {};
}

constexpr float digit(char c) {
    return static_cast<float>(c <= '9' ? c - '0' : c - 'a' + 10);
}

/// One stop, 0 to 255.
std::array<float, 3> stop(std::string_view table, std::size_t i) {
    std::array<float, 3> rgb{};
    for (std::size_t c = 0; c < 3; ++c) rgb[c] = 16.0F * digit(table[7 * i + 2 * c]) + digit(table[7 * i + 2 * c + 1]);
    return rgb;
}

}  // namespace

Rgb color_of(ColorMap map, double part) {
    const double place = std::clamp(part, 0.0, 1.0) * static_cast<double>(stops - 1);
    const std::size_t below = std::min(static_cast<std::size_t>(place), stops - 2);
    const auto mix = static_cast<float>(place - static_cast<double>(below));
    const std::array<float, 3> a = stop(table(map), below);
    const std::array<float, 3> b = stop(table(map), below + 1);
    Rgb rgb{};
    for (std::size_t c = 0; c < 3; ++c) rgb[c] = static_cast<std::uint8_t>(std::lround(a[c] + mix * (b[c] - a[c])));
    return rgb;
}

}  // namespace meniscus::cli
