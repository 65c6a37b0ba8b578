// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
"use strict";

// What the graphics card does. It reads points, corners and values from textures of this width.

const TEXTURE_WIDTH = 2048;
const MISSING = 3e38; // stands for NaN, which drivers do not treat alike

const VERTEX_SHADER = `#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;
uniform sampler2D points, values, normals;
uniform usampler2D corners;
uniform mat4 projection;
uniform mat3 turn;
uniform highp int kind; // 0: no values, 1: at points, 2: at triangles
uniform bool coloured;
flat out vec3 atCorners;
out vec3 share, normal, colour, place;
ivec2 at(int i) { return ivec2(i % ${TEXTURE_WIDTH}, i / ${TEXTURE_WIDTH}); }
void main() {
  int triangle = gl_VertexID / 3, corner = gl_VertexID % 3;
  uvec3 ids = uvec3(texelFetch(corners, at(3 * triangle), 0).r,
    texelFetch(corners, at(3 * triangle + 1), 0).r, texelFetch(corners, at(3 * triangle + 2), 0).r);
  share = vec3(corner == 0, corner == 1, corner == 2);
  int own = int(ids[corner]);
  atCorners = vec3(0);
  colour = vec3(0);
  if (coloured) {
    colour = texelFetch(values, at(kind == 2 ? triangle : own), 0).rgb;
  } else if (kind == 1) {
    atCorners = vec3(texelFetch(values, at(int(ids.x)), 0).r, texelFetch(values, at(int(ids.y)), 0).r,
      texelFetch(values, at(int(ids.z)), 0).r);
  } else if (kind == 2) {
    atCorners = vec3(texelFetch(values, at(triangle), 0).r);
  }
  vec3 point = texelFetch(points, at(own), 0).rgb;
  normal = turn * texelFetch(normals, at(gl_VertexID), 0).rgb;
  place = turn * point;
  gl_Position = projection * vec4(point, 1);
}`;

const FRAGMENT_SHADER = `#version 300 es
precision highp float;
uniform highp int kind;
uniform bool coloured, labels;
uniform vec2 range; // of the colours
uniform float interval; // of isolines; 0: none
uniform sampler2D map;
uniform vec3 plain;
flat in vec3 atCorners;
in vec3 share, normal, colour, place;
out vec4 result;
void main() {
  vec3 base = plain;
  float line = 0.0;
  if (coloured) {
    base = colour;
  } else if (kind != 0) {
    vec3 known = vec3(lessThan(atCorners, vec3(${MISSING / 3})));
    float part = dot(share, known);
    float nearest = share.x >= share.y && share.x >= share.z ? atCorners.x
      : share.y >= share.z ? atCorners.y : atCorners.z;
    float value = labels ? nearest : dot(share * known, atCorners) / max(part, 1e-6);
    if (labels ? nearest < ${MISSING / 3} : part > 0.5) {
      base = texture(map, vec2(clamp((value - range.x) / max(range.y - range.x, 1e-30), 0.0, 1.0), 0.5)).rgb;
      if (interval > 0.0 && part > 0.999) {
        float phase = value / interval, width = max(fwidth(phase), 1e-6);
        line = (1.0 - smoothstep(0.6, 1.5, abs(fract(phase + 0.5) - 0.5) / width))
          * (1.0 - smoothstep(0.2, 0.5, width)) // lines that are too dense would cover all,
          * step(2e-5, width); // and so would one where the values are constant
      }
    }
  }
  vec3 n = normal;
  if (dot(n, n) < 1e-6) { n = cross(dFdx(place), dFdy(place)); }
  n = normalize(n);
  float facing = n.z;
  bool behind = facing < 0.0;
  if (behind) { n = -n; }
  // A light over the left shoulder, and a weaker one from the right, so that shapes read well.
  float light = 0.34 + 0.56 * max(dot(n, normalize(vec3(-0.35, 0.5, 1.0))), 0.0)
    + 0.14 * max(dot(n, normalize(vec3(0.9, -0.2, 0.5))), 0.0);
  base *= behind && !gl_FrontFacing ? 0.82 : 1.0;
  result = vec4(mix(base * light, base * light * 0.25, 0.8 * line), 1);
}`;

const MARK_VERTEX_SHADER = `#version 300 es
precision highp float;
uniform mat4 projection;
uniform float size;
in vec3 point;
void main() {
  gl_Position = projection * vec4(point, 1);
  gl_Position.z -= 3e-4 * size * gl_Position.w; // marks before paths
  gl_PointSize = size;
}`;

const PATH_COLOUR = [0.9, 0.1, 0.5]; // in no map of colours

const MARK_FRAGMENT_SHADER = `#version 300 es
precision highp float;
uniform vec3 fill;
uniform float share; // of the radius, that is filled; the rest is white
out vec4 result;
void main() {
  float r = length(gl_PointCoord - 0.5);
  if (r > 0.5) { discard; }
  result = vec4(2.0 * r > share ? vec3(1) : fill, 1);
}`;
