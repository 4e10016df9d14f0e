"""Distances of points, edges and triangles in numpy, written apart from the solver's own."""

from __future__ import annotations

import numpy as np


def dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Products of vectors."""
    return (a * b).sum(-1)


def point_edge(point: np.ndarray, start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """Distances (m) of points and edges."""
    way = end - start
    share = np.clip(dot(point - start, way) / dot(way, way), 0.0, 1.0)
    return np.linalg.norm(start + share[..., None] * way - point, axis=-1)


def point_triangle(point: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """Distances (m) of a point and triangles."""
    after = np.roll(corners, -1, axis=1)
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(normal, axis=1)
    sides = dot(np.cross(after - corners, point - corners), normal[:, None])
    is_above = (sides >= 0).all(1) & (length > 0)
    height = np.abs(dot(point - corners[:, 0], normal)) / np.where(length > 0, length, 1.0)
    return np.where(is_above, height, point_edge(point, corners, after).min(1))


def edge_triangle(edge: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """Distances (m) of an edge and triangles."""
    start, end = edge
    ends = np.minimum(point_triangle(start, corners), point_triangle(end, corners))
    after = np.roll(corners, -1, axis=1)
    distances = np.minimum(ends, edge_edge(start, end, corners, after).min(1))
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    from_start, from_end = (dot(point - corners[:, 0], normal) for point in edge)
    sides = dot(np.cross(corners - start, after - start), end - start)
    is_through = ((sides >= 0).all(1) | (sides <= 0).all(1)) & (from_start * from_end < 0)
    return np.where(is_through, 0.0, distances)


def edge_edge(
    start: np.ndarray, end: np.ndarray, starts: np.ndarray, ends: np.ndarray
) -> np.ndarray:
    """Distances (m) of an edge and edges."""
    near = np.minimum(point_edge(start, starts, ends), point_edge(end, starts, ends))
    near = np.minimum(near, point_edge(starts, start, end))
    near = np.minimum(near, point_edge(ends, start, end))
    one, other, between = end - start, ends - starts, starts - start
    a, b, c = dot(one, one), dot(one, other), dot(other, other)
    d, e = dot(one, between), dot(other, between)
    area = a * c - b * b
    safe = np.where(area > 0, area, 1.0)
    s, t = (c * d - b * e) / safe, (b * d - a * e) / safe
    is_inside = (area > 0) & (s > 0) & (s < 1) & (t > 0) & (t < 1)
    apart = between + t[..., None] * other - s[..., None] * one
    return np.where(is_inside, np.linalg.norm(apart, axis=-1), near)
