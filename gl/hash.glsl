// hash32 of core/sampling.h, and a random number in [0, 1) from 32 bits.
uint hash32(uint x) {
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  return x ^ (x >> 16);
}
uint hash32(uint a, uint b) {
  return hash32(a ^ (hash32(b) + 0x9e3779b9u));
}
uint hash32(uint a, uint b, uint c) {
  return hash32(a, hash32(b, c));
}
