// The tables of what coats keep from the base under them (CoatTables of gl/pack_brdf.h).
layout(binding = 7) uniform samplerBuffer coats;
