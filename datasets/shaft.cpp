// A stepped shaft with chamfers, grooves and fillets.
#include "datasets/shapes.h"
#include "datasets/turning.h"

namespace quadseg::datasets {

void make_shaft(Builder& builder, Pcg random) {
    const auto vary = [&](double value) { return value * random.uniform(0.9, 1.1); };
    const double end = vary(5);
    const double seat = vary(7);
    const double collar = vary(10);
    const double bearing = vary(6.5);
    const double chamfer = vary(0.8);
    const double fillet = vary(1.2);
    const double groove = vary(0.9);
    const double round = vary(1.4);

    const double largest_loop = 2 * std::numbers::pi * (seat + collar) / 2;
    const std::uint32_t count = 4 * builder.steps(largest_loop / 4, 2);
    const Frame frame{};
    double z = 0;  // the chain runs down from the upper end
    const double total = 70;

    const double lower_end = bearing - chamfer;
    Turning lower(builder, Frame{{0, 0, -total}}.flipped(), count);
    lower.disc(lower_end, 0);
    const Loop last = mirrored(lower.loop());

    Turning chain(builder, frame, count);
    chain.disc(end - chamfer, z);
    chain.line_to(end, z -= chamfer);
    chain.line_to(end, z -= vary(7));
    // A groove of round section, a half torus.
    const std::int32_t half_torus = chain.arc_to(end - groove, z - groove, end, z - groove);
    chain.arc_to(end, z - 2 * groove, end, z - groove, half_torus);
    z -= 2 * groove;
    chain.line_to(end, z -= vary(5));
    // Fillet up to the shoulder of the seat.
    chain.arc_to(end + fillet, z - fillet, end + fillet, z);
    z -= fillet;
    chain.line_to(seat, z);
    chain.line_to(seat, z -= vary(12));
    // A square groove.
    chain.line_to(seat - groove, z);
    chain.line_to(seat - groove, z -= vary(2));
    chain.line_to(seat, z);
    chain.line_to(seat, z -= vary(4));
    // The collar: a cone up, a rounded edge down.
    chain.line_to(collar, z -= vary(4));
    chain.line_to(collar, z -= vary(5));
    chain.arc_to(collar - round, z - round, collar - round, z);
    z -= round;
    chain.line_to(bearing + fillet, z);
    chain.arc_to(bearing, z - fillet, bearing + fillet, z - fillet);
    z -= fillet;
    chain.line_to(bearing, -total + chamfer);
    chain.line_to(lower_end, -total, &last);
}

}  // namespace quadseg::datasets
