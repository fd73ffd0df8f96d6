// Pixels of planes, of which an invocation does four below each other.

// Adds gathered light, linear between the four probes around, to a column of a cell: four pixels. The cell and those around
// are one surface, so that probes need no test.
void addLightOfPlane(ivec2 pixel, inout vec4 colors[4]) {
  ivec2 cell = pixel >> 2;
  float across = 0.25 * float(pixel.x & 3);
  uvec4 a = texelFetch(probesImage, cell, 0), b = texelFetch(probesImage, cell + ivec2(1, 0), 0);
  uvec4 c = texelFetch(probesImage, cell + ivec2(0, 1), 0), d = texelFetch(probesImage, cell + ivec2(1, 1), 0);
  vec3 added = mix(addedOf(a), addedOf(b), across), convexity = vec3(0.0);
  vec3 addedStep = 0.25 * (mix(addedOf(c), addedOf(d), across) - added), convexityStep = vec3(0.0);
  if ((someLight & kSomeConvexity) != 0u) {
    convexity = mix(convexityOf(a), convexityOf(b), across);
    convexityStep = 0.25 * (mix(convexityOf(c), convexityOf(d), across) - convexity);
  }
  [[unroll]] for (int i = 0; i < 4; ++i)
    colors[i].rgb = withLight(colors[i].rgb, added + float(i) * addedStep, convexity + float(i) * convexityStep);
}

// Level 2 at a pixel's column, in the row of its texel and those above and below. `texel`: in upsampled[]; `splineX`:
// splineAt the column.
void coarserRows(int texel, vec3 splineX, out vec3 rows[3]) {
  [[unroll]] for (int y = 0; y < 3; ++y) {
    int row = texel + (y - 1) * kWindowX;
    rows[y] = splineX.x * unpackHalves(upsampled[row - 1].xy) + splineX.y * unpackHalves(upsampled[row].xy) +
              splineX.z * unpackHalves(upsampled[row + 1].xy);
  }
}

// Level 2 at the pixel's row.
vec3 coarserAt(vec3 rows[3], int y) {
  vec3 splineY = splineAt(y);
  return splineY.x * rows[0] + splineY.y * rows[1] + splineY.z * rows[2];
}

// Stores a column of pixels, the first one at `top`, with what light was gathered.
void storeColumn(ivec2 top, vec4 result[4]) {
  if (kGathers && someLight != 0u) addLightOfPlane(top, result);
  // All pixels share a branch, because branches cost more than what is in them.
  if (tinted(pass.value.w != 0u))
    [[unroll]] for (int i = 0; i < 4; ++i)
      result[i].rgb = sanitize(result[i].rgb * albedoAt(top + ivec2(0, i)));
  // The halves that keep alpha lose bits that wide outputs have.
  if (hasFlag(PELLUCID_FLAG_WIDE_OUTPUT))
    [[unroll]] for (int i = 0; i < 4; ++i)
      result[i].a = texelFetch(sourceImage, top + ivec2(0, i), 0).a;
  if (adds(pass.value.w != 0u))
    [[unroll]] for (int i = 0; i < 4; ++i)
      result[i] = onHeld(top + ivec2(0, i), result[i].rgb);
  [[unroll]] for (int i = 0; i < 4; ++i)
    imageStore(destinationImage, top + ivec2(0, i), vec4(asStored(result[i].rgb), result[i].a));
}

// `sources`: the invocation's column of pixels with its ring; `shaped`: texels have shapes. For all invocations, as they
// wait for each other.
void diffusePlanes(ivec2 firstTexel, vec4 sources[kRows + 2 * kMostRing], bool shaped) {
  int column = ownColumn(), firstRow = ownRow(), invocation = int(gl_LocalInvocationIndex);
  uvec2 own[kRows]; // colors and alphas
  // An invocation's rows are those of one texel.
  FineFilter columns = columnFilter(shares[(firstRow / 4 + 1) * kWindowX + (column - kRing + 4) / 4].z, shaped);
  [[unroll]] for (int i = 0; i < kRows; ++i) {
    vec4 source = sources[i + 2];
    own[i] = uvec2(packHalf2x16(source.rg), packHalf2x16(source.ba));
    if (kFine) {
      vec3 sum = fineSum(columns, sources[i].rgb, sources[i + 1].rgb, source.rgb, sources[i + 3].rgb, sources[i + 4].rgb);
      vertical[(firstRow + i) * kColumns + column] = uvec2(packHalf2x16(sum.rg), packHalf2x16(vec2(sum.b, 0.0)));
    }
  }
  if (edgeBands != 0u && invocation < kWindowX * kWindowY) prepareForEdges(invocation);
  barrier();

  int x = column - kRing, index = (firstRow / 4 + 1) * kWindowX + x / 4 + 1;
  if (x >= 0 && x < 4 * kTexelsX && isPlane(upsampled[index])) {
    vec3 coarser[3];
    coarserRows(index, splineAt(x), coarser);
    uvec3 bits = shares[index].xyz;
    PixelShares share = unpackShares(bits);
    FineFilter rows = rowFilter(bits.z, shaped);
    vec4 result[4];
    [[unroll]] for (int i = 0; i < 4; ++i) {
      vec2 blue = unpackHalf2x16(own[i].y);
      vec3 color = vec3(unpackHalf2x16(own[i].x), blue.x);
      if (kFine) color = mix(color, fineOf(rows, (firstRow + i) * kColumns + column), share.fine);
      result[i] = vec4(mix(color, coarserAt(coarser, i), share.coarser), blue.y);
    }
    storeColumn(4 * firstTexel + ivec2(x, firstRow), result);
  }
}
