//! A value of given rank among numbered slots, kept up to date as slots change: two heaps meeting at that rank.
//!
//! Sorting the window anew would cost O(W log W) per iteration. Here the smaller values live in a heap with the largest
//! on top, the others in a heap with the smallest on top; changing one slot moves one value along one heap, O(log W).
//! Every slot knows its place in its heap, so the value that leaves the window is found without a search.

/// The values of slots `0..len`, split at a rank that grows with their number.
#[derive(Clone, Debug)]
pub(crate) struct Ranks {
    fraction: f64,
    values: Vec<f64>,
    /// Index of each slot in the heap that holds it.
    places: Vec<usize>,
    /// Which heap holds each slot.
    in_low: Vec<bool>,
    low: Heap<Largest>,
    high: Heap<Smallest>,
}

impl Ranks {
    /// Room for `capacity` slots, split at this fraction, 0 < fraction < 1; never allocates again.
    pub(crate) fn new(capacity: usize, fraction: f64) -> Self {
        Self {
            fraction,
            values: Vec::with_capacity(capacity),
            places: Vec::with_capacity(capacity),
            in_low: Vec::with_capacity(capacity),
            low: Heap::new(capacity),
            high: Heap::new(capacity),
        }
    }

    /// Values in slot order.
    pub(crate) fn values(&self) -> &[f64] {
        &self.values
    }

    pub(crate) fn clear(&mut self) {
        self.values.clear();
        self.places.clear();
        self.in_low.clear();
        self.low.slots.clear();
        self.high.slots.clear();
    }

    /// Fills the next empty slot.
    pub(crate) fn push(&mut self, value: f64) {
        let slot = self.values.len();
        self.values.push(value);
        self.places.push(0);
        let below = self.low.top().is_none_or(|top| value <= self.values[top]);
        self.in_low.push(below);
        if below {
            self.low.insert(slot, &self.values, &mut self.places);
        } else {
            self.high.insert(slot, &self.values, &mut self.places);
        }
        self.balance();
    }

    /// Puts another value into a filled slot.
    pub(crate) fn replace(&mut self, slot: usize, value: f64) {
        self.values[slot] = value;
        let place = self.places[slot];
        if self.in_low[slot] {
            self.low.settle(place, &self.values, &mut self.places);
        } else {
            self.high.settle(place, &self.values, &mut self.places);
        }
        // At most one value is now on the wrong side, and then it is on top of its heap.
        if let (Some(low), Some(high)) = (self.low.top(), self.high.top())
            && self.values[low] > self.values[high]
        {
            self.low.slots[0] = high;
            self.high.slots[0] = low;
            self.in_low[high] = true;
            self.in_low[low] = false;
            self.low.settle(0, &self.values, &mut self.places);
            self.high.settle(0, &self.values, &mut self.places);
        }
    }

    /// The value at rank `fraction · (len − 1)`, between two neighbours by linear interpolation; none when empty.
    pub(crate) fn at_fraction(&self) -> Option<f64> {
        let low = self.values[self.low.top()?];
        let high = self.high.top().map_or(low, |slot| self.values[slot]);
        Some(low + (self.rank() - self.rank().floor()) * (high - low))
    }

    /// Rank, counted from zero, where the heaps meet.
    fn rank(&self) -> f64 {
        self.fraction * (self.values.len() as f64 - 1.0)
    }

    /// Makes the lower heap hold exactly the values of rank `0..=⌊rank⌋`.
    fn balance(&mut self) {
        let target = self.rank() as usize + 1;
        while self.low.slots.len() > target {
            let slot = self.low.take_top(&self.values, &mut self.places);
            self.in_low[slot] = false;
            self.high.insert(slot, &self.values, &mut self.places);
        }
        while self.low.slots.len() < target {
            let slot = self.high.take_top(&self.values, &mut self.places);
            self.in_low[slot] = true;
            self.low.insert(slot, &self.values, &mut self.places);
        }
    }
}

/// Which of two values belongs nearer to the top.
trait Order {
    fn before(a: f64, b: f64) -> bool;
}

#[derive(Clone, Debug)]
struct Largest;

impl Order for Largest {
    fn before(a: f64, b: f64) -> bool {
        a > b
    }
}

#[derive(Clone, Debug)]
struct Smallest;

impl Order for Smallest {
    fn before(a: f64, b: f64) -> bool {
        a < b
    }
}

/// A binary heap of slots that tells each slot its place.
#[derive(Clone, Debug)]
struct Heap<O> {
    slots: Vec<usize>,
    order: std::marker::PhantomData<O>,
}

impl<O: Order> Heap<O> {
    fn new(capacity: usize) -> Self {
        Self {
            slots: Vec::with_capacity(capacity),
            order: std::marker::PhantomData,
        }
    }

    fn top(&self) -> Option<usize> {
        self.slots.first().copied()
    }

    fn insert(&mut self, slot: usize, values: &[f64], places: &mut [usize]) {
        self.slots.push(slot);
        self.settle(self.slots.len() - 1, values, places);
    }

    fn take_top(&mut self, values: &[f64], places: &mut [usize]) -> usize {
        let top = self.slots.swap_remove(0);
        if !self.slots.is_empty() {
            self.settle(0, values, places);
        }
        top
    }

    /// Moves the slot at this place up or down until the order holds again.
    fn settle(&mut self, mut place: usize, values: &[f64], places: &mut [usize]) {
        let slot = self.slots[place];
        let value = values[slot];
        while place > 0 {
            let parent = (place - 1) / 2;
            if !O::before(value, values[self.slots[parent]]) {
                break;
            }
            self.put(place, self.slots[parent], places);
            place = parent;
        }
        loop {
            let (left, right) = (2 * place + 1, 2 * place + 2);
            let Some(&left_slot) = self.slots.get(left) else {
                break;
            };
            let (child, child_slot) = match self.slots.get(right) {
                Some(&right_slot) if O::before(values[right_slot], values[left_slot]) => {
                    (right, right_slot)
                }
                _ => (left, left_slot),
            };
            if !O::before(values[child_slot], value) {
                break;
            }
            self.put(place, child_slot, places);
            place = child;
        }
        self.put(place, slot, places);
    }

    fn put(&mut self, place: usize, slot: usize, places: &mut [usize]) {
        self.slots[place] = slot;
        places[slot] = place;
    }
}
