/* What a shared library shows: everything else is compiled hidden. tests/abi lists the names. C and C++. */
#ifndef QUADSEG_EXPORT_H
#define QUADSEG_EXPORT_H

#if defined(__GNUC__) || defined(__clang__)
#define QUADSEG_API __attribute__((visibility("default")))
#define QUADSEG_LOCAL __attribute__((visibility("hidden")))
#else
#define QUADSEG_API
#define QUADSEG_LOCAL
#endif

#endif
