// The generators by name. Each makes its solid with a builder; dimensions come from the seed.
#pragma once

#include "datasets/builder.h"
#include "datasets/pcg.h"

namespace quadseg::datasets {

using Shape = void (*)(Builder& builder, Pcg random);

void make_plate(Builder& builder, Pcg random);
void make_shaft(Builder& builder, Pcg random);
void make_flange(Builder& builder, Pcg random);
void make_quadrics(Builder& builder, Pcg random);
void make_fillets(Builder& builder, Pcg random);
void make_rounded_octahedron(Builder& builder, Pcg random);

}  // namespace quadseg::datasets
