//! Work spread over threads: results in the order of the work, whoever did it.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use anyhow::Result;

/// Between two looks at the progress.
const LOOK: Duration = Duration::from_millis(250);

/// Does `work` on every item, on up to `threads` threads, each with its own `worker`; `look` is
/// called now and then meanwhile. The first failure by order of the items ends it all.
pub(super) fn spread<I: Sync, W, T: Send>(
    items: &[I],
    threads: usize,
    worker: impl Fn() -> Result<W> + Sync,
    work: impl Fn(&mut W, &I) -> Result<T> + Sync,
    mut look: impl FnMut(),
) -> Result<Vec<T>> {
    let (next, failed) = (AtomicUsize::new(0), AtomicBool::new(false));
    let (sender, receiver) = channel();
    let mut results: Vec<Option<Result<T>>> = items.iter().map(|_| None).collect();
    thread::scope(|scope| {
        for _ in 0..threads.clamp(1, items.len().max(1)) {
            let sender = sender.clone();
            let (next, failed, worker, work) = (&next, &failed, &worker, &work);
            scope.spawn(move || {
                let mut own = None;
                while !failed.load(Ordering::Relaxed) {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    let Some(item) = items.get(index) else { break };
                    let result = match own.take().map_or_else(worker, Ok) {
                        Ok(mut worker) => {
                            let result = work(&mut worker, item);
                            own = Some(worker);
                            result
                        }
                        Err(error) => Err(error),
                    };
                    if result.is_err() {
                        failed.store(true, Ordering::Relaxed);
                    }
                    // Whoever listens does so until all of us are gone.
                    let _ = sender.send((index, result));
                }
            });
        }
        drop(sender);
        loop {
            match receiver.recv_timeout(LOOK) {
                Ok((index, result)) => results[index] = Some(result),
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => break,
            }
            look();
        }
    });
    // After a failure items are missing, but only behind one that failed or was being done.
    let mut done = Vec::with_capacity(items.len());
    let mut missing = false;
    for result in results {
        match result {
            Some(Ok(value)) => done.push(value),
            Some(Err(error)) => return Err(error),
            None => missing = true,
        }
    }
    assert!(!missing, "an item can only be missing after a failure");
    Ok(done)
}

#[cfg(test)]
mod tests {
    use super::*;
    use anyhow::bail;

    #[test]
    fn results_come_in_the_order_of_the_items_whatever_the_threads() {
        let items: Vec<u64> = (0..100).collect();
        for threads in [1, 2, 7, 500] {
            let squares = spread(
                &items,
                threads,
                || Ok(0_u64),
                |calls, item| {
                    *calls += 1;
                    Ok(item * item)
                },
                || {},
            )
            .unwrap();
            assert!(
                squares
                    .iter()
                    .zip(&items)
                    .all(|(got, item)| *got == item * item)
            );
        }
    }

    #[test]
    fn a_failure_ends_it() {
        let items: Vec<u64> = (0..1_000).collect();
        let failing = |_: &mut (), item: &u64| {
            if *item == 3 {
                bail!("item {item}");
            }
            Ok(())
        };
        let error = spread(&items, 2, || Ok(()), failing, || {}).unwrap_err();
        assert_eq!(error.to_string(), "item 3");
        let none = spread(&items, 2, || bail!("no worker"), |(), _| Ok(()), || {});
        assert_eq!(none.unwrap_err().to_string(), "no worker");
        assert_eq!(
            spread(&[], 2, || Ok(()), |(), (): &()| Ok(()), || {}).unwrap(),
            [(); 0]
        );
    }
}
