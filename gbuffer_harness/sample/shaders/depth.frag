#version 450
// Shadow maps and the back faces' depth.
void main() {}
